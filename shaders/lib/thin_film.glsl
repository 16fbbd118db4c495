// Reflectance of a thin film over a base: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying
// Iridescence" (2017), in the form of KHR_materials_iridescence: Schlick's reflectance, Airy's sum up to m = 2, Gaussian fits of the
// sensitivities of the eye.
#ifndef GLIM_LIB_THIN_FILM
#define GLIM_LIB_THIN_FILM

#include "fresnel.glsl"
#include "portable.glsl"
#include "warp.glsl"

// Of an interface whose far side has the index `to`.
vec3 normalReflectance(vec3 to, float from)
{
    vec3 r = (to - from) / (to + from);
    return r * r;
}

// One Gaussian of the fits: its response to a path difference, phase in radians per wave number.
float gaussianResponse(float amplitude, float wavenumber, float variance, float phase, float shift)
{
    float size = amplitude * sqrt(2.0 * kPi * variance) * portableExp(-variance * phase * phase) * (1.0 / 1.0685e-7);
    float turns = (wavenumber * phase + shift) * (0.5 / kPi);
    return size * sampleCircle(fract(turns + 0.5)).x;  // sampleCircle begins at -pi
}

// Linear Rec.709 response to the path difference in nm; the shifts of the phase are per channel.
vec3 filmResponse(float difference, vec3 shift)
{
    float phase = 2.0 * kPi * 1e-9 * difference;
    float x = gaussianResponse(5.4856e-13, 1.6810e6, 4.3278e9, phase, shift.x) + gaussianResponse(9.7470e-14, 2.2399e6, 4.5282e9, phase, shift.x);
    float y = gaussianResponse(4.4201e-13, 1.7953e6, 9.3046e9, phase, shift.y);
    float z = gaussianResponse(5.2481e-13, 2.2084e6, 6.6121e9, phase, shift.z);
    return vec3(3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
}

// In [0, 1]. `cosine` in air; thickness in nm; baseF0: the base's reflectance in air at normal incidence.
vec3 filmReflectance(float cosine, float filmIor, float thickness, vec3 baseF0)
{
    float t = clamp(thickness * (1.0 / 0.03), 0.0, 1.0);
    float ior = mix(1.0, filmIor, t * t * (3.0 - 2.0 * t));  // a film of no thickness has no interface
    float cosine2 = 1.0 - (1.0 - cosine * cosine) / (ior * ior);
    if (cosine2 < 0.0) {
        return vec3(1.0);
    }
    float inside = sqrt(cosine2);
    vec3 root = sqrt(clamp(baseF0, 1e-4, 0.9999));
    vec3 baseIor = (1.0 + root) / (1.0 - root);
    float outer0 = normalReflectance(vec3(ior), 1.0).x;
    float outer = outer0 + (1.0 - outer0) * schlickWeight(cosine);
    vec3 inner0 = normalReflectance(baseIor, ior);
    vec3 inner = inner0 + (1.0 - inner0) * schlickWeight(inside);
    vec3 shift = vec3(ior >= 1.0 ? kPi : 0.0) + mix(vec3(0.0), vec3(kPi), lessThan(baseIor, vec3(ior)));
    float difference = 2.0 * ior * thickness * inside;
    float through = 1.0 - outer;
    vec3 both = min(outer * inner, vec3(0.9999));
    vec3 once = through * through * inner / (1.0 - both);
    vec3 power = sqrt(both);
    vec3 sum = outer + once, damping = power;
    float m = 1.0;
    do {
        sum += (once - through) * damping * 2.0 * filmResponse(m * difference, m * shift);
        damping = both;
        m += 1.0;
    } while (m <= 2.0);
    return clamp(sum, 0.0, 1.0);
}

#endif
