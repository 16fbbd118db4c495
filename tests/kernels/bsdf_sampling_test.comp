// One thread is one sample of one BSDF: `sampleCount` threads for each case. Results: where it goes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "any_bsdf.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { BsdfCase cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { SampledDirection results[]; };

vec3 pointOf(uint kind, uint i)
{
    if (kind == kPointsCorners) {
        float corners[4] = float[4](0.0, 5.9604645e-8, 0.5, 0.99999994);
        return vec3(corners[i % 4u], corners[i / 4u % 4u], corners[i / 16u % 4u]);
    }
    uvec4 bits = hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed));
    return vec3(unitFloat(bits.xy), unitFloat(bits.z));
}

void main()
{
    if (isTestThread()) {
        BsdfCase c = cases[TEST_THREAD / pass.sampleCount];
        Principled p = makePrincipled(c.material, c.wo);
        BsdfSample s = sampleAny(c, p, pointOf(c.points, TEST_THREAD % pass.sampleCount));
        EXPECT_TRUE(isFinite(s.weight) && isFinite(s.pdf) && s.pdf >= 0.0 && isFinite(s.wi));
        EXPECT_TRUE(all(greaterThanEqual(s.weight, vec3(0.0))));
        EXPECT_NEAR(dot(s.wi, s.wi), 1.0, 1e-5);
        BsdfEval e = evalAny(c, p, s.wi);
        EXPECT_TRUE(!(s.pdf > 0.0) || abs(e.pdf - s.pdf) <= 1e-5 * s.pdf);
        EXPECT_TRUE(!(s.pdf > 0.0) || length(e.f - s.weight * s.pdf) <= 1e-5 * length(e.f));
        results[TEST_THREAD] = SampledDirection(s.wi, s.pdf, s.weight, s.flags);
    }
    endTest();
}
