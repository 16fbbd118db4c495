// One thread is one ray and the state of its path: what shadeSurface makes of the hit, or shadeMiss of the miss.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/path_vertex.glsl"
#include "access/traverse.glsl"

struct Case {
    PathRay ray;
    PathState state;
};

struct Result {
    vec3 emitted;
    uint emittedGroup, shadowGroup, environmentGroup;
    FirstHit firstHit;
    uint hasShadowRay;
    ShadowRay shadowRay;
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
        if (hit.primitiveRef == kNoPrimitiveRef) {
            results[TEST_THREAD].emitted = shadeMiss(c.ray, c.state);
            results[TEST_THREAD].environmentGroup = environmentGroup();
        } else {
            VertexResult v = shadeSurface(SampleId(render.seed, TEST_THREAD, 0u), c.ray, hit, c.state);
            results[TEST_THREAD] =
                Result(v.emitted, v.emittedGroup, v.shadowGroup, 0u, v.firstHit, uint(v.hasShadowRay), v.shadowRay, uint(v.hasNextRay), v.ray, v.state);
        }
        EXPECT_TRUE((hit.primitiveRef == kNoPrimitiveRef) == (c.ray.direction.y > 0.0));
    }
    endTest();
}
