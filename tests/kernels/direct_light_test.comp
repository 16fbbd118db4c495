// One thread is one receiver: its shadow ray, and the light that a ray from it hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/path_vertex.glsl"
#include "access/traverse.glsl"

struct Case {
    vec3 point, ns, ng, towards;
    PathState state;
};

struct Result {
    uint asks;
    ShadowRay ray;
    uint finds;  // a surface; else the environment
    vec3 emitted;  // the environment times throughput
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

vec3 lightFound(Case c, PathRay ray, PathHit hit)
{
    if (hit.primitiveRef == kNoPrimitiveRef) {
        return shadeMiss(ray, c.state);
    }
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    return weightedEmission(si, fetchMaterial(si.material), ray, hit, c.state);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SurfaceInteraction si = SurfaceInteraction(c.point, vec3(0.0), c.ng, c.ns, vec2(0.0), true, 0u, 77u, 0u, 0u, kNoInstance);
        ShadowRay shadow = ShadowRay(vec3(0.0), 0u, vec3(0.0), 0u, vec3(0.0), 0.0);
        SurfaceMaterial material = makeSurfaceMaterial(si);
        Bsdf bsdf = makeBsdf(si, material, c.ns);
        uint group;
        LightChoice choice;
        SampleId id = SampleId(render.seed, TEST_THREAD, 0u);
        LightSample light = sampleDirectLight(id, makeLightContext(si, bsdf), c.state.bounce, choice, group);
        bool asks = makeShadowRay(si, light, evalBsdf(bsdf, c.ns, light.wi), c.state, shadow);
        PathRay ray = PathRay(c.point, kNoPrimitive, c.towards, 0u);
        PathHit hit = traceClosest(ray);
        results[TEST_THREAD] = Result(uint(asks), shadow, uint(hit.primitiveRef != kNoPrimitiveRef), lightFound(c, ray, hit));
        EXPECT_TRUE(!asks || shadow.source == 77u);
    }
    endTest();
}
