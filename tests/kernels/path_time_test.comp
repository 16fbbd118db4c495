// One thread is a sample of a pixel, or a light path. Writes its time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/path_time.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint isLight[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float times[]; };

void main()
{
    SampleId id = SampleId(render.seed, TEST_THREAD >> 6u, TEST_THREAD & 63u);
    if (isLight[TEST_THREAD] == 0u) {
        beginPath(id);
    } else {
        beginLightPath(lightPathId(render.seed, id.pixel, id.index));
    }
    times[TEST_THREAD] = pathTime;
    endTest();
}
