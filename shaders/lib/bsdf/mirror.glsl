// The delta lobe of a perfect mirror. It cannot be evaluated and has no pdf: its direction is found only by sampling.
#ifndef GLIM_LIB_BSDF_MIRROR
#define GLIM_LIB_BSDF_MIRROR

#include "bsdf_sample.glsl"
#include "lib/fresnel.glsl"

// Reflects about n, a unit vector on the side of wo; both are in world space. `color` is the reflectance at normal incidence; Schlick's
// approximation raises it towards grazing angles, as glTF specifies for metals.
BsdfSample sampleMirror(vec3 color, vec3 wo, vec3 n)
{
    return BsdfSample(reflectAbout(wo, n), fresnelSchlick(color, dot(wo, n)), 0.0, 1.0, kBsdfDelta);
}

#endif
