// One thread is one pair of pdfs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/mis.glsl"

struct Case {
    float f, g;
    float weight;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_NEAR(powerHeuristic(c.f, c.g), c.weight, 4e-7 * c.weight + kSmallestNormal);
        EXPECT_TRUE(max(c.f, c.g) < kSmallestNormal || isNear(powerHeuristic(c.f, c.g) + powerHeuristic(c.g, c.f), 1.0, 2e-7));
    }
    endTest();
}
