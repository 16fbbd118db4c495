// Reflection and refraction at smooth interfaces.
#ifndef GLIM_LIB_FRESNEL
#define GLIM_LIB_FRESNEL

// Squared cosine of the refracted direction, 1 - sin^2 / eta^2; negative on total internal reflection. Computed as (eta^2 - 1 + cos^2) /
// eta^2: at grazing incidence and eta near 1 its terms are as small as the result.
float refractedCosine2(float cosine, float eta)
{
    return ((eta - 1.0) * (eta + 1.0) + cosine * cosine) / (eta * eta);
}

// Fresnel reflectance of a dielectric interface for unpolarised light. `eta`: index of refraction beyond the interface over that before it;
// `cosine`: of the incident direction, in [0, 1]. 1 on total internal reflection, 0 if eta is 1.
float fresnelDielectric(float cosine, float eta)
{
    float c = clamp(cosine, 0.0, 1.0);
    if (eta == 1.0) {
        return 0.0;
    }
    float k = refractedCosine2(c, eta);
    if (!(k > 0.0)) {
        return 1.0;
    }
    float t = sqrt(k);
    float parallel = (eta * c - t) / (eta * c + t);
    float perpendicular = (c - eta * t) / (c + eta * t);
    return min(1.0, 0.5 * (parallel * parallel + perpendicular * perpendicular));
}

// The weight of F90 against F0. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994.
float schlickWeight(float cosine)
{
    float m = clamp(1.0 - cosine, 0.0, 1.0), m2 = m * m;
    return m2 * m2 * m;
}

vec3 fresnelSchlick(vec3 normalReflectance, float cosine)
{
    return normalReflectance + (1.0 - normalReflectance) * schlickWeight(cosine);
}

// The mirror direction of wo; both point away from the surface. n: unit.
vec3 reflectAbout(vec3 wo, vec3 n)
{
    return 2.0 * dot(wo, n) * n - wo;
}

// The refracted direction, a unit vector that points away from the surface on the other side. Needs dot(wo, n) >= 0 and no total internal
// reflection. With eta == 1 it is exactly -wo.
vec3 refractThrough(vec3 wo, vec3 n, float eta)
{
    if (eta == 1.0) {
        return -wo;
    }
    float c = dot(wo, n);
    float k = refractedCosine2(c, eta);
    vec3 wi = (c / eta - sqrt(max(0.0, k))) * n - wo / eta;
    return wi / sqrt(dot(wi, wi));
}

#endif
