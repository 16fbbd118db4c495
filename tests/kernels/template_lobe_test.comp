// One thread is one sample of one case: pass.sampleCount threads for each. The first kLobeCells of them also integrate over one cell each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"
#include "template_lobe.glsl"

// The sphere in cells of equal solid angle: bands of z, and sectors of the azimuth.
const uint kBands = 32u, kSectors = 32u, kLobeCells = kBands * kSectors;
// Gauss and Legendre's, along each side of a cell.
const float kNodes[4] = float[4](0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558);
const float kWeights[4] = float[4](0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226);

struct Case {
    vec3 wo;
    float exponent;
    float albedo;
};

struct Result {
    vec3 wi;
    float weight;
    float density, reflected;  // the integrals of density and lobe over the cell of this thread
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

vec3 directionAt(vec2 square)
{
    float z = 1.0 - 2.0 * square.x;
    return vec3(sqrt(max(0.0, 1.0 - z * z)) * sampleCircle(square.y), z);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD / pass.sampleCount];
        vec2 u = unitFloat(hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed)).xy);
        BsdfSample s = sampleTemplateLobe(vec3(c.albedo), c.exponent, c.wo, u);
        EXPECT_NEAR(dot(s.wi, s.wi), 1.0, 2e-6);
        EXPECT_TRUE(isFinite(s.weight) && all(greaterThanEqual(s.weight, vec3(0.0))));
        EXPECT_TRUE(s.wi.z > 0.0 || s.weight == vec3(0.0));
        EXPECT_CLOSE(s.pdf, pdfTemplateLobe(c.exponent, c.wo, s.wi), 1e-6);
        EXPECT_CLOSE(s.weight.x * s.pdf, evalTemplateLobe(vec3(c.albedo), c.exponent, c.wo, s.wi).x, 1e-6);
        // Reciprocity, of the BSDF without its cosine. Rounding of the mirror direction's cosine grows by the exponent.
        float there = evalTemplateLobe(vec3(c.albedo), c.exponent, c.wo, s.wi).x * c.wo.z;
        EXPECT_TRUE(!(s.wi.z > 0.0) || isNear(evalTemplateLobe(vec3(c.albedo), c.exponent, s.wi, c.wo).x * s.wi.z, there, 1e-4 * there));

        uint cell = TEST_THREAD % pass.sampleCount;
        vec2 sum = vec2(0.0);
        for (uint i = 0u; cell < kLobeCells && i < 16u; ++i) {
            vec2 inCell = vec2(kNodes[i / 4u], kNodes[i % 4u]);
            vec3 wi = directionAt((vec2(cell / kSectors, cell % kSectors) + inCell) / vec2(kBands, kSectors));
            float weight = kWeights[i / 4u] * kWeights[i % 4u] * 4.0 * kPi / float(kLobeCells);
            sum += weight * vec2(pdfTemplateLobe(c.exponent, c.wo, wi), evalTemplateLobe(vec3(c.albedo), c.exponent, c.wo, wi).x);
        }
        results[TEST_THREAD] = Result(s.wi, s.weight.x, sum.x, sum.y);
    }
    endTest();
}
