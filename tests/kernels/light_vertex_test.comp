// One thread is one ray of a light path and the path's state: the vertex where the ray meets the scene.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light_vertex.glsl"
#include "access/traverse.glsl"

struct Case {
    PathRay ray;
    PathState state;
};

struct Result {
    uint hasSplat;
    uint pixel;
    ShadowRay cameraRay;
    uint hasNextRay;
    PathRay ray;
    PathState state;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PathHit hit = traceClosest(c.ray);
        EXPECT_TRUE(hit.primitiveRef != kNoPrimitiveRef);
        LightVertex v = shadeLightVertex(lightPathId(render.seed, TEST_THREAD, 0u), c.ray, hit, c.state);
        results[TEST_THREAD] = Result(uint(v.hasSplat), v.pixel, v.cameraRay, uint(v.hasNextRay), v.ray, v.state);
    }
    endTest();
}
