// One thread is one white material without a diffuse lobe, seen from one direction in a white furnace. Result: what it reflects and
// transmits, by midpoints.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "material_case.glsl"

struct Case {
    vec3 wo;
    MaterialCase material;
    float tolerance;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float results[]; };

const uint kSide = 64u;

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Principled all = makePrincipled(c.material, c.wo), single = all, further = all;
        single.scattered = single.diffuse = single.diffuseThrough = single.glassAbove = single.glassBelow = vec3(0.0);
        further.isSmooth = true;  // leaves the microfacets' lobes out
        further.diffuse = vec3(0.0);
        float sum = 0.0;
        for (uint i = 0u; i < kSide * kSide; ++i) {
            vec2 u = (vec2(i / kSide, i % kSide) + 0.5) / float(kSide);
            vec3 h = sampleVisibleNormal(c.wo, all.alpha, u), reflected = reflectAbout(c.wo, h);
            vec3 through = all.solid ? refractThrough(c.wo, h, all.eta) : vec3(reflected.xy, -reflected.z);
            bool refracts = !all.solid || refractedCosine2(dot(c.wo, h), all.eta) > 0.0;
            if (reflected.z > 0.0) {
                sum += evalPrincipled(single, c.wo, reflected).f.r / pdfGgx(c.wo, reflected, all.alpha);
            }
            if (refracts && through.z < 0.0) {
                vec3 mirrored = vec3(through.xy, -through.z);
                float pdf = all.solid ? pdfGgxTransmission(c.wo, through, refractionNormal(c.wo, through, all.eta), all.alpha, all.eta)
                                      : pdfGgx(c.wo, mirrored, all.alpha);
                float f = evalPrincipled(single, c.wo, through).f.r * all.eta * all.eta;
                sum += pdf > 0.0 ? f / pdf : 0.0;
            }
            vec3 wi = sampleMultipleScattering(u, all.scatteredAlpha);
            if (wi.z > 0.0) {
                vec3 f = evalPrincipled(further, c.wo, wi).f + evalPrincipled(further, c.wo, -wi).f * (all.eta * all.eta);
                sum += f.r / pdfMultipleScattering(wi.z, all.scatteredAlpha);
            }
        }
        float albedo = sum / float(kSide * kSide);
        EXPECT_NEAR(albedo, 1.0, c.tolerance);
        results[TEST_THREAD] = albedo;
    }
    endTest();
}
