// The course's Russian roulette.
#ifndef GLIM_LIB_COURSE_FIXED_ROULETTE
#define GLIM_LIB_COURSE_FIXED_ROULETTE

// Probability to continue: a fixed q after one guaranteed indirect bounce. In a closed room of albedo a the variance is infinite where a^2
// >= q, for q = .7 above a = .837.
float fixedContinuation(float q, uint bounce)
{
    return bounce == 0u ? 1.0 : q;
}

#endif
