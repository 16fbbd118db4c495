// The two delta lobes of a smooth dielectric interface: reflection and refraction.
#ifndef GLIM_LIB_BSDF_DIELECTRIC
#define GLIM_LIB_BSDF_DIELECTRIC

#include "bsdf_sample.glsl"
#include "lib/fresnel.glsl"

// n: a unit vector on the side of wo; both are in world space. `eta`: index of refraction beyond the interface over that on wo's side.
// `tint` colours the transmitted light. Reflects if uLobe, in [0, 1), is below the Fresnel reflectance. Transmitted radiance is scaled by 1
// / eta^2, since its solid angle changes (Veach 1997, section 5.2).
BsdfSample sampleDielectric(vec3 tint, float eta, vec3 wo, vec3 n, float uLobe)
{
    float reflected = fresnelDielectric(dot(wo, n), eta);
    if (uLobe < reflected) {
        return BsdfSample(reflectAbout(wo, n), vec3(1.0), 0.0, 1.0, kBsdfDelta);
    }
    return BsdfSample(refractThrough(wo, n, eta), tint / (eta * eta), 0.0, eta, kBsdfDelta | kBsdfTransmission);
}

#endif
