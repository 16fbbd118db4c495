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
        EXPECT_NEAR(weightPower(c.f, c.g), c.weight, 2e-7);
        EXPECT_TRUE(c.f + c.g == 0.0 || isNear(weightPower(c.f, c.g) + weightPower(c.g, c.f), 1.0, 2e-7));
    }
    endTest();
}
