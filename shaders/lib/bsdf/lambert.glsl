// The diffuse lobe: reflects the same radiance into every direction (Lambert 1760). Directions are in the shading frame, whose z
// axis is the shading normal on the side of wo.
#ifndef GLIM_LIB_BSDF_LAMBERT
#define GLIM_LIB_BSDF_LAMBERT

#include "bsdf_sample.glsl"
#include "lib/warp.glsl"

// Per steradian.
float pdfLambert(vec3 wi)
{
    return pdfCosineHemisphere(wi.z);
}

// albedo / pi * |cos|, in sr^-1, on the side of wo.
vec3 evalLambert(vec3 albedo, vec3 wi)
{
    return albedo * pdfLambert(wi);
}

// u in [0, 1)^2. The weight is the albedo exactly; a direction in the surface itself has pdf 0 and weight 0.
BsdfSample sampleLambert(vec3 albedo, vec2 u)
{
    vec3 wi = sampleCosineHemisphere(u);
    return BsdfSample(wi, wi.z > 0.0 ? albedo : vec3(0.0), pdfLambert(wi), 1.0, 0u);
}

#endif
