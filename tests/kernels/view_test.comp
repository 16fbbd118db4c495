// One thread is one pixel of a viewer. Result: its colour in bytes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/display.glsl"

struct Case {
    vec3 value, reference;
    ViewPass view;
    uvec2 at;       // in the window
    vec3 expected;  // bytes, by the host
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec3 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 bytes = 255.0 * viewColor(c.value, c.reference, c.at, c.view);
        // A value of .5 may round to either side.
        EXPECT_NEAR(bytes.r, c.expected.r, 1.001);
        EXPECT_NEAR(bytes.g, c.expected.g, 1.001);
        EXPECT_NEAR(bytes.b, c.expected.b, 1.001);
        EXPECT_NEAR(bytes.r, round(bytes.r), 0.001);
        results[TEST_THREAD] = bytes;
    }
    endTest();
}
