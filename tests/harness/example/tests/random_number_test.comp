// One thread is one seed. The host looks at how the numbers are distributed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "harness/kernel_test.glsl"
#include "random_number.glsl"

layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float results[]; };

void main()
{
    if (isTestThread()) {
        uint state = test.seed + TEST_THREAD;
        float x = randomNumber(state);
        EXPECT_NEAR(x, 0.5, 0.5);
        EXPECT_EQUAL(fract(x * 16777216.0), 0.0);
        results[TEST_THREAD] = x;
    }
    endTest();
}
