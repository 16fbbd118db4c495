// One thread is one pixel, looked at one way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/display.glsl"

struct Case {
    PixelMoments pixel;
    uint look;
    DisplayPass display;
    vec3 expected;  // bytes, by the host
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 bytes = 255.0 * displayColor(c.pixel, c.look, c.display);
        // A half may round to either side.
        EXPECT_NEAR(bytes.r, c.expected.r, 1.001);
        EXPECT_NEAR(bytes.g, c.expected.g, 1.001);
        EXPECT_NEAR(bytes.b, c.expected.b, 1.001);
        EXPECT_NEAR(bytes.r, round(bytes.r), 0.001);
    }
    endTest();
}
