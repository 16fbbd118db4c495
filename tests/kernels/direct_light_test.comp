// One thread is one receiver: the shadow ray that it asks for, and the light that a ray from it finds.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/direct_light.glsl"
#include "access/traverse.glsl"

struct Case {
    vec3 point, shading, geometric, towards;
    PathState state;
};

struct Result {
    uint asks;
    ShadowRay ray;
    uint finds;  // a surface; else the environment
    vec3 found;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

vec3 lightFound(Case c, PathRay ray, PathHit hit)
{
    if (hit.record == kNoRecord) {
        return environmentFound(c.state);
    }
    Surface surface = surfaceAt(ray, hit);
    return emissionFound(ray, hit, c.state, surface, fetchMaterial(surface.material));
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Surface surface = Surface(c.point, vec3(0.0), c.geometric, c.shading, true, 0u, 0u, 77u);
        ShadowRay shadow = ShadowRay(vec3(0.0), 0u, vec3(0.0), 0u, vec3(0.0), 0.0);
        bool asks = sampleDirectLight(SampleId(pass.seed, TEST_THREAD, 0u), 1u, c.state, surface, fetchMaterial(0u), shadow);
        PathRay ray = PathRay(c.point, kNoPrimitive, c.towards, 0u);
        PathHit hit = traceClosest(ray);
        results[TEST_THREAD] = Result(uint(asks), shadow, uint(hit.record != kNoRecord), lightFound(c, ray, hit));
        EXPECT_TRUE(!asks || shadow.source == 77u);
    }
    endTest();
}
