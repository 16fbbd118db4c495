// Detects that the driver has silently ended a loop too early.
#ifndef GLIM_LIB_CANARY
#define GLIM_LIB_CANARY

// Some drivers have a loop budget (driver_bugs.md): once it is spent, every loop runs once, silently. `steps` must be 3 and unknown to the compiler. True if the budget is spent.
bool isLoopBudgetSpent(uint steps)
{
    uint done = 0u;
    for (uint i = 0u; i < steps; ++i) {
        done += 1u + (i >> 8u);
    }
    return done < steps;
}

#endif
