// One thread is one sample, every tenth of which is not finite.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/status.glsl"
#include "expect.glsl"

void main()
{
    if (isTestThread() && TEST_THREAD % 10u == 0u) {
        reportNonFinite(TEST_THREAD, TEST_THREAD + 7u);
    }
    checkLoopBudget(TEST_THREAD == 0u ? pass.canarySteps : 3u);
    EXPECT_TRUE(!isLoopBudgetSpent(pass.canarySteps));
    endTest();
}
