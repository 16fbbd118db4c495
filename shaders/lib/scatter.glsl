// How materials scatter. Directions point away from the surface; frames have the shading normal as z.
#ifndef GLIM_LIB_SCATTER
#define GLIM_LIB_SCATTER

#include "fresnel.glsl"
#include "warp.glsl"

// A direction to go on in. `weight` = scattering function * cosine / pdf. `pdf` per steradian, 0 for a mirror or glass.
// A weight of zero ends the path.
struct Scatter {
    vec3 wi;
    vec3 weight;
    float pdf;
    float etaScale;  // squared index of the side entered over that left; 1 for reflection
};

// Lambert: albedo / pi, in sr^-1; the cosine is not included. `cosine`: of wi against the normal on wo's side; 0 across.
vec3 evalLambert(vec3 albedo, float cosine)
{
    return cosine > 0.0 ? albedo * (1.0 / kPi) : vec3(0.0);
}

// Per steradian.
float pdfLambert(float cosine)
{
    return pdfCosineHemisphere(cosine);
}

// On the side of wo. The weight is the albedo exactly; a direction in the surface has pdf 0 and is dropped.
Scatter sampleLambert(vec3 albedo, vec2 u)
{
    vec3 wi = sampleCosineHemisphere(u);
    return Scatter(wi, wi.z > 0.0 ? albedo : vec3(0.0), pdfLambert(wi.z), 1.0);
}

// A perfect mirror with Schlick's Fresnel over its colour, as glTF has for metals. n: unit, on the side of wo.
Scatter sampleMirror(vec3 color, vec3 wo, vec3 n)
{
    return Scatter(reflectAbout(wo, n), fresnelSchlick(color, dot(wo, n)), 0.0, 1.0);
}

// A smooth interface to a medium of index `ior`; `tint` colours what passes. Radiance is squeezed by the square of the
// relative index on the way in and released on the way out. One of reflection and refraction by u in [0, 1).
Scatter sampleGlass(vec3 tint, float ior, bool front, vec3 wo, vec3 n, float u)
{
    float eta = front ? ior : 1.0 / ior;
    float reflected = fresnelDielectric(dot(wo, n), eta);
    if (u < reflected) {
        return Scatter(reflectAbout(wo, n), vec3(1.0), 0.0, 1.0);
    }
    return Scatter(refractThrough(wo, n, eta), tint / (eta * eta), 0.0, eta * eta);
}

#endif
