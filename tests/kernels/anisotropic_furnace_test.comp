// One thread is one white metal seen from one direction in a white furnace. Result: what it reflects, by midpoints.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "material_case.glsl"

struct Case {
    vec3 wo;
    MaterialCase material;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float results[]; };

const uint kSide = 128u;

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Principled p = makePrincipled(c.material, c.wo);
        Principled scattered = p;
        scattered.isSmooth = true;  // leaves the single reflections out
        float sum = 0.0;
        for (uint i = 0u; i < kSide * kSide; ++i) {
            vec2 u = (vec2(i / kSide, i % kSide) + 0.5) / float(kSide);
            vec3 wi = sampleGgx(c.wo, p.alpha, u), further = sampleMultipleScattering(u, p.scatteredAlpha);
            if (wi.z > 0.0) {
                sum += evalGgx(c.wo, wi, p.alpha) / pdfGgx(c.wo, wi, p.alpha);
            }
            if (further.z > 0.0) {
                sum += evalPrincipled(scattered, c.wo, further).f.r / pdfMultipleScattering(further.z, p.scatteredAlpha);
            }
        }
        float albedo = sum / float(kSide * kSide);
        EXPECT_NEAR(albedo, 0.9975, 0.0075);  // .99 to 1.005
        results[TEST_THREAD] = albedo;
    }
    endTest();
}
