// One thread is one path that already has some light and gets more.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_RADIANCE
#define UPDATES_GROUP_LIGHT
#include "access/course/radiance.glsl"
#include "expect.glsl"

struct Case {
    vec3 contribution;
    uint pathLength;
    uint share;  // 1: one of the light samples of a round
    uint group;  // of lights
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        if (c.share != 0u) {
            addShareOfRadiance(TEST_THREAD, c.contribution, c.pathLength);
        } else {
            addRadiance(TEST_THREAD, c.contribution, c.pathLength);
            addToGroup(TEST_THREAD, c.group, c.contribution, c.pathLength);
        }
    }
    endTest();
}
