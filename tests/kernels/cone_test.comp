// One thread is one cone and one pair of numbers. Result: the direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/cone.glsl"

struct Case {
    float sin2;
    vec2 u;
    float oneMinusCos, pdf;  // expected
    vec2 across;             // the direction's x and y
    float rise;              // and 1 - z
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec3 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        // Difference, square root, sum, quotient: at most 5 half ulps with Vulkan's division.
        EXPECT_CLOSE(oneMinusCosCone(c.sin2), c.oneMinusCos, 3e-7);
        EXPECT_CLOSE(pdfCone(c.sin2), c.pdf, 1e-6);
        vec3 w = sampleCone(c.u, c.sin2);
        // Azimuth: 3 units of 2^-24 of pi, and the errors of sin and cos.
        EXPECT_TRUE(distance(w.xy, c.across) <= 1e-6 * length(c.across));
        EXPECT_NEAR(1.0 - w.z, c.rise, 6e-8 + 3e-7 * c.rise);
        results[TEST_THREAD] = w;
    }
    endTest();
}
