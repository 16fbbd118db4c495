// One thread is one direction in a spot's beam, and one distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/punctual.glsl"

struct Case {
    float cosine, cosInner, cosOuter;
    float falloff;
    float distance_, range;
    float window;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_NEAR(spotFalloff(c.cosine, c.cosInner, c.cosOuter), c.falloff, 2e-6);
        EXPECT_NEAR(rangeFalloff(c.distance_ * c.distance_, c.range), c.window, 1e-6);
    }
    endTest();
}
