// One thread is a pair of noisy pixels. Result: their distance, and the weight of a patch that differs by so much.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/nl_means.glsl"

struct Case {
    vec3 meanA, varianceA, meanB, varianceB;
    float distance, tolerance;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float distance = pixelDistance(c.meanA, c.varianceA, c.meanB, c.varianceB);
        float weight = patchWeight(distance);
        EXPECT_NEAR(distance, c.distance, c.tolerance);
        EXPECT_TRUE(weight >= 0.0 && weight <= 1.0);
        EXPECT_NEAR(weight, exp(-max(distance, 0.0)), 1e-5);
        results[TEST_THREAD] = vec2(distance, weight);
    }
    endTest();
}
