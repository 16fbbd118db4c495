// One thread is one point, and looks for the media around it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/start_media.glsl"
#include "access/traverse.glsl"

struct Case {
    vec3 point;
    uint media;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Steps steps = Steps(0u, 0u);
        EXPECT_EQUAL(mediaAround(cases[TEST_THREAD].point, steps), cases[TEST_THREAD].media);
    }
    endTest();
}
