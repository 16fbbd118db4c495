// One thread is one direction in a spot's beam.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/punctual.glsl"

struct Case {
    float cosine, cosInner, cosOuter;
    float falloff;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_NEAR(spotFalloff(c.cosine, c.cosInner, c.cosOuter), c.falloff, 2e-6);
    }
    endTest();
}
