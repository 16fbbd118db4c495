// One thread is one direction in the cone of one spot.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/punctual.glsl"

struct Case {
    float cosine, cosInner, cosOuter;
    float falloff, tolerance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_NEAR(spotFalloff(c.cosine, c.cosInner, c.cosOuter), c.falloff, c.tolerance);
        EXPECT_EQUAL(spotFalloff(c.cosOuter, c.cosInner, c.cosOuter), 0.0);
        EXPECT_EQUAL(spotFalloff(-1.0, c.cosInner, c.cosOuter), 0.0);
        bool sharp = c.cosInner - c.cosOuter < 1.1e-4;  // the rim is then 1e-4 wide in the cosine
        EXPECT_TRUE(sharp || spotFalloff(c.cosInner, c.cosInner, c.cosOuter) == 1.0);
        EXPECT_EQUAL(spotFalloff(c.cosOuter + 2e-4, c.cosOuter, c.cosOuter), 1.0);
        EXPECT_NEAR(spotFalloff(c.cosOuter + 5e-5, c.cosOuter, c.cosOuter), 0.25, 2e-3);
        EXPECT_TRUE(spotFalloff(c.cosine, c.cosInner, c.cosOuter) <= spotFalloff(c.cosine + 1e-3, c.cosInner, c.cosOuter));
    }
    endTest();
}
