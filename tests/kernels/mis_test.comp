// One thread is one pair of densities.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/mis.glsl"

struct Case {
    float f, g;
    float weight;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float w = weightPower(c.f, c.g);
        // Two divisions of 2.5 ulp, the ratio's error doubled by squaring: 17 half ulps. Denormals may be flushed.
        EXPECT_NEAR(w, c.weight, 1e-6 * c.weight + 1.2e-38);
        EXPECT_TRUE(w >= 0.0 && w <= 1.0);
        bool some = c.f > 0.0 || c.g > 0.0;
        EXPECT_NEAR(w + weightPower(c.g, c.f), some ? 1.0 : 0.0, 2e-7);
    }
    endTest();
}
