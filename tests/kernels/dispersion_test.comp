// One thread is one index at one wavelength, and one cell of the numbers that choose a wavelength. Result: its colour and wavelength.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/dispersion.glsl"

struct Case {
    float nm, ior, spread;
    float expected;
    vec2 u;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec4 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_CLOSE(iorAt(c.nm, c.ior, c.spread), c.expected, 3e-7);
        EXPECT_EQUAL(iorAt(c.nm, c.ior, 0.0), c.ior);
        Wavelength w = sampleWavelength(c.u);
        float center = w.color.r > 0.0 ? 611.0 : w.color.g > 0.0 ? 549.0 : 465.0;
        EXPECT_EQUAL(w.color.r + w.color.g + w.color.b, 3.0);
        EXPECT_TRUE(abs(w.nm - center) <= 60.0);
        results[TEST_THREAD] = vec4(w.color, w.nm - center);
    }
    endTest();
}
