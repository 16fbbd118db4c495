// One thread is one pixel, looked at one way. Result: its radiance as indices of bytes, by conversion alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/display.glsl"

struct Case {
    PixelMoments pixel;
    uint aov;
    DisplayPass display;
    uvec2 at;       // in the window
    vec3 expected;  // bytes, by the host
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec3 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 bytes = 255.0 * overCheckers(drawnColor(c.pixel, c.aov, c.display), c.at);
        // A value of .5 may round to either side.
        EXPECT_NEAR(bytes.r, c.expected.r, 1.001);
        EXPECT_NEAR(bytes.g, c.expected.g, 1.001);
        EXPECT_NEAR(bytes.b, c.expected.b, 1.001);
        EXPECT_NEAR(bytes.r, round(bytes.r), 0.001);
        results[TEST_THREAD] = uvec3(255.0 * c.display.scale * c.pixel.mean + 0.5);
    }
    endTest();
}
