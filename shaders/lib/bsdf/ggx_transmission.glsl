// Transmission through an interface of GGX microfacets, and through a thin wall: Walter et al., "Microfacet Models for Refraction through
// Rough Surfaces" (2007), with the masking of ggx.glsl. Directions are in the shading frame: wo.z > 0, wi.z < 0. `eta`: the index of
// refraction beyond the interface over that on wo's side. Fresnel transmittance and colour are left to the caller.
#ifndef GLIM_LIB_BSDF_GGX_TRANSMISSION
#define GLIM_LIB_BSDF_GGX_TRANSMISSION

#include "ggx.glsl"

// Closer to 1 an interface bends nothing that float could tell, and has no half vector.
const float kMinEtaStep = 1e-4;

// The microfacet's normal, on the upper side, that refracts wo to wi; z <= 0 if there is none.
vec3 refractionNormal(vec3 wo, vec3 wi, float eta)
{
    vec3 h = wo + eta * wi;
    h /= length(h);
    h = eta > 1.0 ? -h : h;
    return dot(wo, h) > 0.0 && dot(wi, h) < 0.0 ? h : vec3(0.0, 0.0, -1.0);
}

// |d h / d wi|, eq. 17.
float refractionJacobian(vec3 wo, vec3 wi, vec3 h, float eta)
{
    float denominator = dot(wo, h) + eta * dot(wi, h);
    return eta * eta * -dot(wi, h) / (denominator * denominator);
}

// The lobe for a transmittance of 1, times |cos| of wi, eq. 21. It is that of radiance, which the change of its solid angle scales by 1 /
// eta^2 (Veach 1997, section 5.2).
float evalGgxTransmission(vec3 wo, vec3 wi, vec3 h, vec2 alpha, float eta)
{
    float lambdas = -wi.z * stretchedLength(wo, alpha) + wo.z * stretchedLength(wi, alpha);
    return 2.0 * dot(wo, h) * distributionGgx(h, alpha) * refractionJacobian(wo, wi, h, eta) * -wi.z / (lambdas * eta * eta);
}

// The density, per steradian, of refracting wo at a visible normal.
float pdfGgxTransmission(vec3 wo, vec3 wi, vec3 h, vec2 alpha, float eta)
{
    return 2.0 * dot(wo, h) * distributionGgx(h, alpha) / (wo.z + stretchedLength(wo, alpha)) * refractionJacobian(wo, wi, h, eta);
}

#endif
