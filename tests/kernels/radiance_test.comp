// One thread is one path that already has some light and gets more.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_RADIANCE
#include "expect.glsl"
#include "access/radiance.glsl"

struct Case {
    vec3 contribution;
    uint events;
    uint samples;
    PathRadiance expected;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        addRadiance(TEST_THREAD, c.contribution, c.events, c.samples);
        PathRadiance sum = pathRadiance[TEST_THREAD];
        EXPECT_NEAR_VECTOR(sum.radiance, c.expected.radiance, 4e-7 * length(c.expected.radiance));
        // The difference of contribution and kept: as right as the larger of them.
        EXPECT_NEAR(sum.clamped, c.expected.clamped, 4e-7 * (length(c.contribution) + c.expected.clamped));
    }
    endTest();
}
