// One thread is one colour. Result: the largest error, and how far the colour is from 0 to 1.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "shared/tone_mapping.h"

struct Case {
    vec3 color;
    float tone;
    vec3 expected;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 shown = mapTone(c.color, uint(c.tone));
        EXPECT_NEAR(shown.r, c.expected.r, 1e-5);
        EXPECT_NEAR(shown.g, c.expected.g, 1e-5);
        EXPECT_NEAR(shown.b, c.expected.b, 1e-5);
        vec3 error = abs(shown - c.expected), outside = max(-shown, shown - 1.0);
        results[TEST_THREAD] = vec2(max(error.r, max(error.g, error.b)), max(0.0, max(outside.r, max(outside.g, outside.b))));
    }
    endTest();
}
