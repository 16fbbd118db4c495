// A power of the cosine to the mirror direction: Lafortune and Willems, "Using the Modified Phong Reflectance Model for Physically Based
// Rendering" (1994). Directions are in the shading frame, whose z axis is the shading normal on the side of wo.
#ifndef GLIM_LIB_TEMPLATE_LOBE
#define GLIM_LIB_TEMPLATE_LOBE

#include "lib/bsdf/bsdf_sample.glsl"
#include "lib/frame.glsl"
#include "lib/warp.glsl"

vec3 mirrorTemplateLobe(vec3 wo)
{
    return vec3(-wo.xy, wo.z);
}

// Per steradian, of all directions: those below the surface are sampled, too, and carry nothing.
float pdfTemplateLobe(float exponent, vec3 wo, vec3 wi)
{
    return (exponent + 1.0) * (0.5 / kPi) * portablePow(max(dot(mirrorTemplateLobe(wo), wi), 0.0), exponent);
}

// The BSDF times |cos| of wi, in sr^-1.
vec3 evalTemplateLobe(vec3 albedo, float exponent, vec3 wo, vec3 wi)
{
    return albedo * ((exponent + 2.0) / (exponent + 1.0) * pdfTemplateLobe(exponent, wo, wi) * max(wi.z, 0.0));
}

// u in [0, 1)^2.
BsdfSample sampleTemplateLobe(vec3 albedo, float exponent, vec3 wo, vec2 u)
{
    float cosine = portablePow(1.0 - u.x, 1.0 / (exponent + 1.0));
    vec3 local = vec3(sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine))) * sampleCircle(u.y), cosine);
    vec3 wi = worldFromFrame(makeFrame(mirrorTemplateLobe(wo)), local);
    BsdfEval all = BsdfEval(evalTemplateLobe(albedo, exponent, wo, wi), pdfTemplateLobe(exponent, wo, wi));
    return weightSample(BsdfSample(wi, vec3(0.0), 0.0, 1.0, kBsdfUnweighted), all);
}

#endif
