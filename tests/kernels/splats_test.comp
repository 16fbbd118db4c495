// One thread adds one contribution to a pixel. Result: the splats, in a buffer of the test's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/splats.glsl"

struct Case {
    uint pixel;
    uint sampleIndex;
    uint pathLength;
    vec3 contribution;
    uint group;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        addSplat(c.pixel, c.sampleIndex, c.contribution, c.pathLength, c.group, 0.0);
    }
    endTest();
}
