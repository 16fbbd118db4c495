// One thread runs a loop of as many steps as its case says. Result: how many ran, and what the canary says afterwards.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/canary.glsl"

struct Result {
    uint steps;
    uint hash;   // so that the loop is not folded away
    uint spent;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    // Before the loop, unlike in other tests: afterwards the harness would find the budget spent, which is the subject here.
    EXPECT_TRUE(!isLoopBudgetSpent(pass.canarySteps));
    endTest();
    if (isTestThread()) {
        Result result = Result(0u, 1u, 0u);
        for (uint i = 0u; i < cases[TEST_THREAD]; ++i) {
            result.hash = (result.hash ^ i) * 16777619u;
            ++result.steps;
        }
        result.spent = isLoopBudgetSpent(pass.canarySteps) ? 1u : 0u;
        results[TEST_THREAD] = result;
    }
}
