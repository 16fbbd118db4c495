// The glTF material at a point (glTF 2.0, appendix B; KHR_materials_ior and _specular): one GGX lobe over a diffuse base.
//
// Metal and dielectric share the distribution of microfacets, and Schlick's reflectance is linear in F0 and F90. So the mix of the two
// BSDFs by `metallic` is exactly one GGX lobe with mixed F0 and F90, and a diffuse lobe of colour base (1 - metallic). The specification's
// own coupling of the two reflects up to 1.68 of the light; here the diffuse lobe gets what the interface lets through both ways, and
// light that single scattering loses between microfacets comes back (lib/bsdf/multiple_scattering.glsl). Both are sampled by the cosine.
#ifndef GLIM_ACCESS_PRINCIPLED
#define GLIM_ACCESS_PRINCIPLED

#include "albedo_table.glsl"
#include "lib/bsdf/ggx.glsl"
#include "lib/bsdf/multiple_scattering.glsl"
#include "lib/fresnel.glsl"
#include "lib/luminance.glsl"

// A lobe that is not black is sampled with at least this probability.
const float kLeastLobeProbability = 0.02;

struct Principled {
    vec2 alpha;
    bool smooth_;            // the GGX lobe is a delta lobe
    vec3 f0;
    float f90;
    vec2 baseReflectance;    // F0 and F90 of the interface over the diffuse lobe, by its strongest channel
    float baseFms;           // its multipleScatteringFresnel
    vec3 scattered, diffuse; // of the cosine lobes: what does not depend on wi (evalCosineLobes)
    AlbedoRow row;
    float specularProbability;
};

float interfaceAlbedo(Principled p, vec2 ab)
{
    return interfaceAlbedo(ab, p.baseReflectance.xxx, p.baseReflectance.y, p.baseFms.xxx).x;
}

// `cosine`: of wo against the shading normal, above 0.
Principled makePrincipled(PrincipledData data, vec3 baseColor, float cosine)
{
    Principled p;
    float alpha = data.roughness * data.roughness;
    p.alpha = vec2(alpha);
    p.smooth_ = alpha < kMinAlpha;
    vec3 dielectric = min(data.reflectance * data.specularColor, vec3(1.0)) * data.specular;
    p.f0 = mix(dielectric, baseColor, data.metallic);
    p.f90 = mix(data.specular, 1.0, data.metallic);
    p.baseReflectance = vec2(max(dielectric.r, max(dielectric.g, dielectric.b)), data.specular);
    p.row = albedoRow(alpha);
    vec2 ab = fetchAlbedo(p.row, cosine);
    vec2 average = fetchAverageAlbedo(p.row);
    p.baseFms = multipleScatteringFresnel(average, p.baseReflectance.xxx, p.baseReflectance.y).x;
    // Mixed like the two BSDFs, for it is convex in F0: of the mixed F0, a white half-metal of roughness 1 would reflect .78 of the light.
    vec3 fms = mix(multipleScatteringFresnel(average, dielectric, data.specular),
                   multipleScatteringFresnel(average, baseColor, 1.0), data.metallic);
    vec3 scattered = fms * (1.0 - ab.x - ab.y);
    vec3 diffuse = baseColor * (1.0 - data.metallic) * (1.0 - interfaceAlbedo(p, ab));
    float specular = luminanceOf(singleScatteringAlbedo(ab, p.f0, p.f90));
    float below = luminanceOf(scattered + diffuse);
    float probability = clamp(specular / (specular + below), kLeastLobeProbability, 1.0 - kLeastLobeProbability);
    p.specularProbability = !(specular > 0.0) ? 0.0 : !(below > 0.0) ? 1.0 : probability;
    p.scattered = scattered / (kPi * max(1.0 - average.x - average.y, 1e-6));
    p.diffuse = diffuse / (kPi * max(1.0 - interfaceAlbedo(p, average), 1e-6));
    return p;
}

// Both diffuse lobes times |cos|, in sr^-1. `cosine`: of wi, above 0.
vec3 evalCosineLobes(Principled p, float cosine)
{
    vec2 ab = fetchAlbedo(p.row, cosine);
    return (p.scattered * (1.0 - ab.x - ab.y) + p.diffuse * (1.0 - interfaceAlbedo(p, ab))) * cosine;
}

vec3 fresnelSchlick(Principled p, float cosine)
{
    float m = clamp(1.0 - cosine, 0.0, 1.0), m2 = m * m;
    return p.f0 + (p.f90 - p.f0) * (m2 * m2 * m);
}

// All lobes that are not delta. Directions in the shading frame with z > 0.
BsdfEval evalPrincipled(Principled p, vec3 wo, vec3 wi)
{
    BsdfEval result = BsdfEval(evalCosineLobes(p, wi.z), (1.0 - p.specularProbability) * pdfCosineHemisphere(wi.z));
    if (!p.smooth_) {
        result.f += fresnelSchlick(p, dot(wo, halfVector(wo, wi))) * evalGgx(wo, wi, p.alpha);
        result.pdf += p.specularProbability * pdfGgx(wo, wi, p.alpha);
    }
    return result;
}

// Directions in the shading frame. The weight is that of all lobes together, divided by the density of the mixture.
BsdfSample samplePrincipled(Principled p, vec3 wo, vec2 u, float uLobe)
{
    bool specular = uLobe < p.specularProbability;
    if (specular && p.smooth_) {
        return BsdfSample(vec3(-wo.xy, wo.z), fresnelSchlick(p, wo.z) / p.specularProbability, 0.0, 1.0, kBsdfDelta);
    }
    vec3 wi = specular ? sampleGgx(wo, p.alpha, u) : sampleCosineHemisphere(u);
    if (!(wi.z > 0.0)) {
        return BsdfSample(wi, vec3(0.0), 0.0, 1.0, 0u);
    }
    BsdfEval all = evalPrincipled(p, wo, wi);
    return BsdfSample(wi, all.f / all.pdf, all.pdf, 1.0, 0u);
}

#endif
