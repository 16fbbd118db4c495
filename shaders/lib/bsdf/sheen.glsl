// The Charlie sheen of KHR_materials_sheen: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017). alpha: the square of
// sheenRoughness. Directions are in the shading frame with z > 0. The lobe is sampled by a uniform hemisphere, because at grazing view it
// is as wide as the hemisphere.
#ifndef GLIM_LIB_BSDF_SHEEN
#define GLIM_LIB_BSDF_SHEEN

#include "lib/portable.glsl"
#include "lib/warp.glsl"
#include "shared/microfacets.h"

const float kMinSheenRoughness = 0.01;  // below, the lobe is left out: it is narrower than float can resolve

const float kPdfSheen = 0.5 / kPi;

vec3 sampleSheen(vec2 u)
{
    vec2 circle = sampleCircle(u.x);
    return vec3(sqrt(u.y * (2.0 - u.y)) * circle, 1.0 - u.y);
}

// Lambda, section 3.
float sheenMasking(float cosine, float alpha)
{
    SheenFit fit = fitSheen(alpha);
    float x = min(cosine, 1.0 - cosine);
    float l = evalSheenFit(fit, x, portablePow(x, fit.c));
    return portableExp(cosine < 0.5 ? l : 2.0 * evalSheenFit(fit, 0.5, portablePow(0.5, fit.c)) - l);
}

// The lobe for the colour white, times |cos| of wi, in sr^-1. Its albedo exceeds 1 at low roughness: see sheenScale.
float evalSheen(vec3 wo, vec3 wi, float alpha)
{
    vec3 h = wo + wi;
    h /= length(h);
    float sine = length(h.xy);
    float d = (2.0 + 1.0 / alpha) * portablePow(sine, 1.0 / alpha) * (0.5 / kPi);
    return d / ((1.0 + sheenMasking(wo.z, alpha) + sheenMasking(wi.z, alpha)) * 4.0 * wo.z);
}

// The reciprocal factor that brings the albedo to at most 1 for both directions. eOut, eIn: their albedos.
float sheenScale(float eOut, float eIn)
{
    return 1.0 / max(1.0, max(eOut, eIn));
}

#endif
