// One thread is one interface seen at one cosine.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/multiple_scattering.glsl"

struct Case {
    vec2 ab, average;  // the two albedo functions, and their averages
    vec3 f0;
    float f90;
    vec3 fms, albedo;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 fms = multipleScatteringFresnel(c.average, c.f0, c.f90), albedo = interfaceAlbedo(c.ab, c.f0, c.f90, fms);
        // 1 - e is off by 2^-24 of 1, which counts where F is near 1.
        EXPECT_NEAR_VECTOR(fms, c.fms, 1e-6);
        EXPECT_NEAR_VECTOR(albedo, c.albedo, 1e-6);
        results[TEST_THREAD] = vec2(length(fms - c.fms), length(albedo - c.albedo));
    }
    endTest();
}
