// Evaluates and samples a BsdfCase.
#ifndef GLIM_TESTS_ANY_BSDF
#define GLIM_TESTS_ANY_BSDF

#include "any_bsdf.h"
#include "material_case.glsl"

vec2 computeAlpha(MaterialCase m)
{
    float alpha = m.roughness * m.roughness;
    return max(vec2(mix(alpha, 1.0, m.anisotropy * m.anisotropy), alpha), kMinAlpha);
}

float etaOf(MaterialCase m) { return m.inside > 0.0 ? 1.0 / m.ior : m.ior; }

// A lobe has the reflectance or transmittance 1.
BsdfEval evalAny(BsdfCase c, Principled p, vec3 wi)
{
    vec2 alpha = computeAlpha(c.material);
    if (c.what == kSampleGgx && wi.z > 0.0) {
        return BsdfEval(vec3(evalGgx(c.wo, wi, alpha)), pdfGgx(c.wo, wi, alpha));
    }
    if (c.what == kSampleTransmission && wi.z < 0.0) {
        float eta = etaOf(c.material);
        vec3 h = refractionNormal(c.wo, wi, eta);
        if (h.z > 0.0) {
            return BsdfEval(vec3(evalGgxTransmission(c.wo, wi, h, alpha, eta)), pdfGgxTransmission(c.wo, wi, h, alpha, eta));
        }
    }
    if (c.what == kSampleSheen && wi.z > 0.0) {
        return BsdfEval(vec3(evalSheen(c.wo, wi, c.material.sheenRoughness * c.material.sheenRoughness)), kPdfSheen);
    }
    return c.what == kSamplePrincipled ? evalPrincipled(p, c.wo, wi) : BsdfEval(vec3(0.0), 0.0);
}

BsdfSample sampleAny(BsdfCase c, Principled p, vec3 u)
{
    if (c.what == kSamplePrincipled) {
        return samplePrincipled(p, c.wo, u.xy, u.z);
    }
    vec2 alpha = computeAlpha(c.material);
    vec3 wi = c.what == kSampleGgx ? sampleGgx(c.wo, alpha, u.xy) : sampleSheen(u.xy);
    bool valid = wi.z > 0.0;
    if (c.what == kSampleTransmission) {
        float eta = etaOf(c.material);
        vec3 h = sampleVisibleNormal(c.wo, alpha, u.xy);
        wi = refractThrough(c.wo, h, eta);
        valid = refractedCosine2(dot(c.wo, h), eta) > 0.0 && wi.z < 0.0;
    }
    BsdfEval all = evalAny(c, p, wi);
    return BsdfSample(wi, valid && all.pdf > 0.0 ? all.f / all.pdf : vec3(0.0), valid ? all.pdf : 0.0, 1.0, 0u);
}

#endif
