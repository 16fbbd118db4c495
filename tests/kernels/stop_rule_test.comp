// One thread is one pixel and one colour. Result: the colour's luminance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/stop_rule.glsl"

struct Case {
    LuminanceMoments moments;
    float tolerance;
    uint constantSamples;
    uint accurate;  // expected
    vec3 color;
    float luminance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_EQUAL(uint(isAccurate(c.moments, c.tolerance, c.constantSamples)), c.accurate);
        // The weights' rounding, the products' and two sums': half an ulp each.
        EXPECT_CLOSE(computeLuminance(c.color), c.luminance, 4.0 / 16777216.0);
        results[TEST_THREAD] = computeLuminance(c.color);
    }
    endTest();
}
