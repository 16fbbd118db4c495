// The energy that single scattering between microfacets loses, and the light that an interface leaves to the diffuse lobe below it. Both
// are diffuse lobes with reciprocal weights: Kulla and Conty, "Revisiting Physically Based Shading at Imageworks" (SIGGRAPH course, 2017).
//
// Schlick's reflectance F0 + (F90 - F0) s is linear in F0 and F90, so the directional albedo of the GGX lobe is F0 a + F90 b, where a and b
// depend only on the direction and the roughness (access/albedo_table.glsl); a + b is the albedo for a reflectance of 1.
#ifndef GLIM_LIB_BSDF_MULTIPLE_SCATTERING
#define GLIM_LIB_BSDF_MULTIPLE_SCATTERING

#include "lib/portable.glsl"
#include "lib/warp.glsl"

// The albedo of single scattering, F0 a + F90 b. `ab`: a and b.
vec3 singleScatteringAlbedo(vec2 ab, vec3 f0, float f90)
{
    return f0 * ab.x + f90 * ab.y;
}

// The share of the lost light that further bounces between microfacets reflect, per channel; 1 for F = 1. `average`: a and b averaged over
// the hemisphere, weighted by the cosine. Schlick's average is F0 + (F90 - F0) / 21.
vec3 multipleScatteringFresnel(vec2 average, vec3 f0, float f90)
{
    float e = average.x + average.y;
    vec3 f = f0 + (f90 - f0) * (1.0 / 21.0);
    return f * f * e / (1.0 - f * (1.0 - e));
}

// Albedo with multiple scattering: `fms` is multipleScatteringFresnel.
vec3 interfaceAlbedo(vec2 ab, vec3 f0, float f90, vec3 fms)
{
    return singleScatteringAlbedo(ab, f0, f90) + fms * (1.0 - ab.x - ab.y);
}

// Of the albedo t + F0 p + F90 q of an interface that refracts (shared/scene_types.h).
vec3 lostLight(vec3 parts, vec3 f0, float f90)
{
    return max(1.0 - (parts.x + f0 * parts.y + f90 * parts.z), 0.0);
}

// The share of what such an interface loses that leaves on the side it came from. eta: the index beyond over that here; `lost`,
// `lostBeyond`: averages over the hemispheres of both sides. `thinner`: the share on the side of the smaller index
// (host/flatten/glass_albedo.cpp); that of the other follows by reciprocity.
vec3 glassReflects(float eta, vec3 lost, vec3 lostBeyond, float thinner)
{
    vec3 ratio = lostBeyond * (eta * eta) / lost;
    return eta > 1.0 ? max(vec3(thinner), 1.0 - ratio) : max(1.0 - (1.0 - thinner) * ratio, 0.0);
}

// Multiply scattered light goes as cos (1 - a - b). Of a rather smooth interface that is nearly all along the surface: 1 - a - b falls as
// alpha^2 / cos^2 there. So the density of the cosine is proportional to cos / (cos^2 + alpha^2), by inversion. By the cosine alone, weights
// reach 65.
vec3 sampleMultipleScattering(vec2 u, float alpha)
{
    float alpha2 = alpha * alpha;
    float cosine2 = min(alpha2 * (portableExp2(u.x * portableLog2(1.0 + 1.0 / alpha2)) - 1.0), 1.0);
    return vec3(sampleCircle(u.y) * sqrt(1.0 - cosine2), sqrt(cosine2));
}

// Per steradian. cosine > 0.
float pdfMultipleScattering(float cosine, float alpha)
{
    float alpha2 = alpha * alpha;
    return cosine / ((cosine * cosine + alpha2) * (kPi * 0.69314718056) * portableLog2(1.0 + 1.0 / alpha2));
}

#endif
