// One thread is one stream of luminances, of which it adds the next `sampleCount`: more would spend the loop budget of some drivers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/stop_rule.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { float samples[]; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { LuminanceMoments results[]; };

void main()
{
    if (isTestThread()) {
        LuminanceMoments moments = results[TEST_THREAD];
        for (uint i = 0u; i < pass.sampleCount; ++i) {
            moments = addLuminance(moments, samples[TEST_THREAD * pass.sampleCount + i], i % 2u == 0u);
        }
        EXPECT_EQUAL(moments.count, results[TEST_THREAD].count + pass.sampleCount);
        EXPECT_EQUAL(moments.met, results[TEST_THREAD].met + (pass.sampleCount + 1u) / 2u);
        results[TEST_THREAD] = moments;
    }
    endTest();
}
