// One thread is one pair of directions on both sides of an interface.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/ggx_transmission.glsl"

struct Case {
    vec3 wo, wi;
    float alpha, eta;
    float eval, evalTolerance, pdf, pdfTolerance;  // expected
    float cosine;                                  // of the Fresnel reflectance
    float reflected, reflectedTolerance;           // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 h = refractionNormal(c.wo, c.wi, c.eta);
        float eval = h.z > 0.0 ? evalGgxTransmission(c.wo, c.wi, h, vec2(c.alpha), c.eta) : 0.0;
        float pdf = h.z > 0.0 ? pdfGgxTransmission(c.wo, c.wi, h, vec2(c.alpha), c.eta) : 0.0;
        EXPECT_NEAR(eval, c.eval, c.evalTolerance);
        EXPECT_NEAR(pdf, c.pdf, c.pdfTolerance);
        EXPECT_NEAR(fresnelDielectric(c.cosine, c.eta), c.reflected, c.reflectedTolerance);
        results[TEST_THREAD] = abs(vec2(eval - c.eval, pdf - c.pdf)) / max(vec2(c.eval, c.pdf), 1e-30);
    }
    endTest();
}
