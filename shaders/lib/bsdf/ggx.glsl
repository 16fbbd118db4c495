// The GGX microfacet lobe: reflection at microfacets whose normals follow the distribution of Trowbridge and Reitz (1975), with
// height-correlated masking and shadowing, as in glTF 2.0, appendix B. Directions are in the shading frame, whose z axis is the shading
// normal on the side of wo. `alpha`: the alphas along x and y, at least kMinAlpha. Fresnel reflectance is left to the caller.
#ifndef GLIM_LIB_BSDF_GGX
#define GLIM_LIB_BSDF_GGX

#include "bsdf_sample.glsl"
#include "lib/fresnel.glsl"
#include "lib/warp.glsl"
#include "shared/microfacets.h"

// Below this alpha the lobe is a delta lobe: its density would leave float's range of good relative precision.
const float kMinAlpha = 1e-3;

// Density of microfacet normals per steradian, for h on the upper side; in terms of sin^2, without cancellation at small alpha.
float distributionGgx(vec3 h, vec2 alpha)
{
    float area = alpha.x * alpha.y;
    vec3 stretched = vec3(h.xy * alpha.yx, h.z * area);
    float ratio = area / dot(stretched, stretched);
    return (1.0 / kPi) * area * ratio * ratio;
}

// Half vector of two directions on the upper side.
vec3 halfVector(vec3 wo, vec3 wi)
{
    vec3 h = wo + wi;
    return h / length(h);
}

// The single-scattering lobe for a reflectance of 1, times |cos| of wi, in sr^-1. Heitz, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs" (JCGT 3(2), 2014), eq. 99, in the form without a division by cosines. Needs wo.z > 0 and wi.z > 0.
float evalGgx(vec3 wo, vec3 wi, vec2 alpha)
{
    float visibility = 0.5 / (wo.z * stretchedLength(wi, alpha) + wi.z * stretchedLength(wo, alpha));
    return visibility * distributionGgx(halfVector(wo, wi), alpha) * wi.z;
}

// The density of sampleGgx, per steradian. Needs wo.z > 0 and wi.z > 0.
float pdfGgx(vec3 wo, vec3 wi, vec2 alpha)
{
    return 0.5 * distributionGgx(halfVector(wo, wi), alpha) / (wo.z + stretchedLength(wo, alpha));
}

// A microfacet normal in proportion to what wo sees of it. Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps" (2023);
// the cap's sin^2 is q (2 - q), which cancels nothing. u in [0, 1)^2.
vec3 sampleVisibleNormal(vec3 wo, vec2 alpha, vec2 u)
{
    vec3 w = vec3(alpha * wo.xy, wo.z);
    w /= length(w);
    float q = u.y * (1.0 + w.z);
    vec3 c = vec3(sqrt(max(0.0, q * (2.0 - q))) * sampleCircle(u.x), 1.0 - q) + w;
    vec3 h = vec3(alpha * c.xy, max(c.z, 0.0));
    return h / length(h);
}

// The sampled direction may lie below the surface; it then carries nothing.
vec3 sampleGgx(vec3 wo, vec2 alpha, vec2 u)
{
    return reflectAbout(wo, sampleVisibleNormal(wo, alpha, u));
}

#endif
