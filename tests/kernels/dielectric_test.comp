// One thread is one cosine-distributed direction and one choice of glass. Result: 1 for reflection from outside, from inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/dielectric.glsl"
#include "lib/hash.glsl"
#include "lib/warp.glsl"

layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec2 results[]; };

void main()
{
    if (isTestThread()) {
        uvec4 bits = hash4(uvec4(TEST_THREAD, render.seed, 0u, 0u));
        vec3 wo = sampleCosineHemisphere(unitFloat(bits.xy));
        vec3 n = vec3(0.0, 0.0, 1.0);
        BsdfSample outside = sampleDielectric(vec3(1.0), 1.5, wo, n, unitFloat(bits.z));
        BsdfSample inside = sampleDielectric(vec3(1.0), 1.0 / 1.5, wo, n, unitFloat(bits.w));
        EXPECT_TRUE(!any(isnan(outside.wi)) && !any(isnan(inside.wi)));
        results[TEST_THREAD] = uvec2(outside.wi.z > 0.0 ? 1u : 0u, inside.wi.z > 0.0 ? 1u : 0u);
    }
    endTest();
}
