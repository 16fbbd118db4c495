// One thread is one path that already has some light and gets more.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_RADIANCE
#include "expect.glsl"
#include "access/radiance.glsl"

struct Case {
    vec3 contribution;
    uint pathLength;
    uint samples;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        addRadiance(TEST_THREAD, c.contribution, c.pathLength, c.samples);
        EXPECT_TRUE(c.samples > 0u);
    }
    endTest();
}
