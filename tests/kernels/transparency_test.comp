// One thread is one sample of a path's ray and a shadow ray along the same line.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/traverse.glsl"
#include "primitive_met.glsl"

struct Case {
    vec3 origin;
    uint source;
    vec3 direction;  // unit
    uint target;
    float tMax;  // the shadow ray's
    uint sides;
};

struct Result {
    uint met;  // primitive
    vec3 weight;
    vec3 clear;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Steps steps = Steps(0u, 0u);
        VisibleHit visible = traceVisible(SampleId(render.seed, 0u, TEST_THREAD), 1u, PathRay(c.origin, c.source, c.direction, 0u), c.sides,
                                          steps);
        vec3 clear = transmittance(ShadowRay(c.origin, c.source, c.direction, c.target, vec3(1.0), c.tMax), c.sides);
        results[TEST_THREAD] = Result(primitiveMet(visible.hit), visible.weight, clear);
    }
    endTest();
}
