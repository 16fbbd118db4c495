// One thread is one ray; what it meets goes back to the host, which knows the surface in double.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/interaction.glsl"
#include "access/traverse.glsl"

struct Result {
    PathHit hit;
    vec3 point, errorBound, ng, ns;
    uint front, material, light;
    vec3 emitted;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { PathRay rays[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        PathRay ray = rays[TEST_THREAD];
        PathHit hit = traceClosest(ray);
        if (hit.primitiveRef == kNoPrimitiveRef) {
            results[TEST_THREAD].hit = hit;
        } else {
            SurfaceInteraction s = makeSurfaceInteraction(ray, hit);
            vec3 ns = s.ns;
            s.ns = visibleNormal(s, -ray.direction);
            bool looksAway = dot(ns, ray.direction) >= 0.0;
            EXPECT_TRUE(s.ns == (looksAway ? s.ng : ns));
            EXPECT_NEAR(dot(s.ng, s.ng), 1.0, 5e-7);
            EXPECT_NEAR(dot(s.ns, s.ns), 1.0, 5e-7);
            EXPECT_TRUE(dot(s.ng, ray.direction) <= 0.0);
            EXPECT_TRUE(dot(s.ns, ray.direction) <= 0.0);
            EXPECT_TRUE(all(greaterThan(s.errorBound, vec3(0.0))));
            MaterialData material = fetchMaterial(s.material);
            vec3 emitted = emittedRadiance(s, material);
            SurfaceInteraction dark = s;
            dark.light = 0u;
            EXPECT_TRUE(emittedRadiance(dark, material) == vec3(0.0));
            results[TEST_THREAD] = Result(hit, s.p, s.errorBound, s.ng, s.ns, uint(s.front), s.material,
                                          s.light, emitted);
        }
    }
    endTest();
}
