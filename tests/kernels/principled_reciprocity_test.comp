// One thread is one opaque material and one pair of directions, both ways. Result: the relative difference.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "material_case.glsl"

struct Case {
    vec3 wo, wi;
    MaterialCase material;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 forth = evalPrincipled(makePrincipled(c.material, c.wo), c.wo, c.wi).f / c.wi.z;
        vec3 back = evalPrincipled(makePrincipled(c.material, c.wi), c.wi, c.wo).f / c.wo.z;
        // Of a smooth metal away from its reflection nothing is left but a rounding error of 1 - E.
        float error = greatest(abs(forth - back) / max(back, 1e-5));
        EXPECT_NEAR(error, 0.0, 1e-5);
        results[TEST_THREAD] = vec2(error, 0.0);
    }
    endTest();
}
