// One thread is one number. The host compares the sums.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "harness/kernel_test.glsl"
#include "prefix_sum.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uint results[]; };

void main()
{
    uint value = isTestThread() ? cases[TEST_THREAD] : 0u;
    uint sum = prefixSum(value);
    EXPECT_TRUE(sum >= value);
    if (isTestThread()) {
        results[TEST_THREAD] = sum;
    }
    endTest();
}
