// One thread is a path at a surface that its ray has met: where it goes on by the course's rules.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/course/round.glsl"
#include "expect.glsl"
#include "access/course/bounce.glsl"

struct Case {
    SurfaceInteraction si;
    PathRay ray;
    PathState state;
};

struct Result {
    uint alive;
    PathRay ray;
    PathState state;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 wo = -c.ray.direction;
        SurfaceMaterial material = makeSurfaceMaterial(c.si);
        Bsdf bsdf = makeBsdf(c.si, material, wo);
        PathState before = c.state;
        bool alive = bouncePath(SampleId(render.seed, TEST_THREAD, 0u), c.si, bsdf, wo, 0u, c.ray, c.state);
        EXPECT_TRUE(!alive || c.state.bounce == before.bounce + 1u);
        results[TEST_THREAD] = Result(uint(alive), c.ray, c.state);
    }
    endTest();
}
