// One thread is one direction in a spot's beam, and one distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/punctual.glsl"

struct Case {
    vec3 a, b;
    float angle;
    float inner, outer;
    float falloff;
    float lightDistance, range;
    float window;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        // Differences are exact to half an ulp of the vectors; products and sums add some.
        EXPECT_NEAR(versine(c.a, c.b), c.angle, 4e-7 * c.angle + 1e-20);
        // The ramp divides rounding by its width.
        EXPECT_NEAR(spotFalloff(versine(c.a, c.b), c.inner, c.outer), c.falloff, 2e-6 * (1.0 + c.outer / max(c.outer - c.inner, 1e-10)));
        EXPECT_NEAR(rangeFalloff(c.lightDistance * c.lightDistance, c.range), c.window, 1e-6);
    }
    endTest();
}
