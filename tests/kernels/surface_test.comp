// One thread is one ray; what it meets goes back to the host, which knows the surface in double.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/surface.glsl"
#include "access/traverse.glsl"

struct Result {
    PathHit hit;
    vec3 point, errorBound, geometric, shading;
    uint front, material, emitter;
    vec3 emitted;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { PathRay rays[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        PathRay ray = rays[TEST_THREAD];
        PathHit hit = traceClosest(ray);
        if (hit.record == kNoRecord) {
            results[TEST_THREAD].hit = hit;
        } else {
            Surface s = surfaceAt(ray, hit);
            vec3 shading = s.shading;
            turnToViewer(s, -ray.direction);
            bool looksAway = dot(shading, ray.direction) >= 0.0;
            EXPECT_TRUE(s.shading == (looksAway ? s.geometric : shading));
            EXPECT_NEAR(dot(s.geometric, s.geometric), 1.0, 5e-7);
            EXPECT_NEAR(dot(s.shading, s.shading), 1.0, 5e-7);
            EXPECT_TRUE(dot(s.geometric, ray.direction) <= 0.0);
            EXPECT_TRUE(dot(s.shading, ray.direction) <= 0.0);
            EXPECT_TRUE(all(greaterThan(s.errorBound, vec3(0.0))));
            FlatMaterial material = fetchMaterial(s.material);
            vec3 emitted = emittedRadiance(s, material);
            Surface dark = s;
            dark.emitter = 0u;
            EXPECT_TRUE(emittedRadiance(dark, material) == vec3(0.0));
            results[TEST_THREAD] = Result(hit, s.point, s.errorBound, s.geometric, s.shading, uint(s.front), s.material,
                                          s.emitter, emitted);
        }
    }
    endTest();
}
