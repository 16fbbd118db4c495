// The glTF material at a point (glTF 2.0, appendix B, and the KHR_materials extensions), from the outside in: a clearcoat, sheen, and an
// interface of GGX microfacets, which reflects and transmits, over a diffuse base.
//
// Metal and dielectric share the distribution of microfacets, and Schlick's reflectance is linear in F0 and F90. So the mix of the two
// BSDFs by `metallic` is exactly one GGX lobe with mixed F0 and F90, and a diffuse lobe of colour base (1 - metallic). The specification's
// own coupling of the two reflects up to 1.68 of the light; here the diffuse lobe gets what the interface lets through both ways, and
// light that single scattering loses between microfacets comes back (lib/bsdf/multiple_scattering.glsl). Both make up the diffuse lobe.
// At an interface that transmits, what microfacets lose leaves on both sides, by reciprocal diffuse lobes too.
// A coat or sheen leaves to what is below the lesser of 1 - E(wo) and 1 - E(wi): reciprocal, and no energy is created over any base.
#ifndef GLIM_ACCESS_PRINCIPLED
#define GLIM_ACCESS_PRINCIPLED

#include "albedo_table.glsl"
#include "lib/bsdf/ggx.glsl"
#include "lib/bsdf/ggx_transmission.glsl"
#include "lib/bsdf/multiple_scattering.glsl"
#include "lib/bsdf/sheen.glsl"
#include "lib/frame.glsl"
#include "lib/fresnel.glsl"
#include "lib/thin_film.glsl"

// A lobe that is not black is sampled with at least this probability, before all of them are scaled to 1.
const float kMinLobeProbability = 0.02;
const float kCoatF0 = 0.04;  // of the index 1.5

// The material's numbers at the point, with textures. Directions and frames of this file are in the shading frame, z on wo's side.
struct PrincipledInput {
    PrincipledData data;
    LayersData layers;
    vec3 baseColor;
    vec3 coatNormal;        // unit, on wo's side
    vec3 ng;                // unit, on wo's side; needed with a coat
    float filmThickness;    // nm
    float eta;              // index beyond the surface over that on wo's side
    bool passesStraight;    // light that a smooth thin wall transmits is not this BSDF's (transparency.glsl)
};

// Reflectance at a microfacet.
struct InterfaceFresnel {
    vec3 dielectric;  // of the part that is not metal
    vec3 metal;
    vec3 both;        // of their mixture
};

struct Principled {
    // The interface.
    vec2 alpha;
    bool isSmooth;          // a delta lobe
    vec3 f0;
    float f90;
    vec3 transmitted;      // colour of light that it transmits, times its share; 0: none
    vec3 dielectricF0;     // of the part that is not metal, which transmits
    float dielectricF90;
    vec3 metalF0;
    float metallic;
    float eta;
    bool solid;             // refracts; else a thin wall
    float glass;            // share of the part that is not metal that transmits at rough microfacets
    vec3 glassAbove, glassBelow;  // of light scattered more than once there: what does not depend on wi
    vec3 film;              // share, index, thickness in nm
    InterfaceFresnel fresnel;  // at wo
    // What lies below it.
    vec2 baseReflectance;    // F0 and F90 of the interface over the diffuse lobe, by its strongest channel
    float baseFms;           // its multipleScatteringFresnel
    vec3 scattered, diffuse; // of the diffuse lobe: what does not depend on wi (evalAbove)
    float scatteredShare;    // of its samples: by sampleMultipleScattering, else by the cosine
    float throughShare;      // the same on the far side
    float scatteredAlpha;
    vec3 diffuseThrough;     // of the cosine lobe on the far side
    AlbedoRow row;           // of a lobe of one width
    // What lies above it.
    float coat;
    vec2 coatAlpha;
    bool coatSmooth;
    Frame coatFrame;
    AlbedoRow coatRow;
    float coatAlbedo;   // at wo
    vec3 ng;
    vec3 sheen;
    float sheenAlpha, sheenAlbedo, sheenMost;  // most: of the channels
    AlbedoRow sheenRow;
    float passed;       // what both leave of light from wo
    // Probabilities of the lobes; they add up to 1.
    float pInterface, pDiffuse, pCoat, pSheen, pThrough;
};

// The interface's a and b at a direction on the upper side.
vec2 fetchAlbedo(Principled p, vec3 w)
{
    if (hasFeature(kFeatureAnisotropy)) {
        if (p.alpha.x != p.alpha.y) {
            return fetchAlbedo(p.alpha, w);
        }
    }
    return fetchAlbedo(p.row, w.z);
}

vec2 fetchAverageAlbedo(Principled p)
{
    if (hasFeature(kFeatureAnisotropy)) {
        if (p.alpha.x != p.alpha.y) {
            return fetchAverageAlbedo(p.alpha);
        }
    }
    return fetchAverageAlbedo(p.row);
}

float interfaceAlbedo(Principled p, vec2 ab)
{
    return interfaceAlbedo(ab, p.baseReflectance.xxx, p.baseReflectance.y, p.baseFms.xxx).x;
}

// Lobes are chosen by the mean of the channels: by luminance, a blue lobe's weights would be up to 14 times those of a white one.
float channelMean(vec3 v) { return (v.r + v.g + v.b) * (1.0 / 3.0); }

float greatest(vec3 v) { return max(v.r, max(v.g, v.b)); }

// Schlick's weight, or for a solid that transmits that of the exact Fresnel reflectance, which is 1 on total internal reflection.
float exactWeight(float cosine, float eta)
{
    float f0 = (eta - 1.0) * (eta - 1.0) / ((eta + 1.0) * (eta + 1.0));
    return clamp((fresnelDielectric(cosine, eta) - f0) / (1.0 - f0), 0.0, 1.0);
}

// Without film and refraction the mixture of both parts is Schlick's with mixed F0 and F90. Within a solid a film is what it is for light
// from outside. `cosine`: against the microfacet. The film's reflectance is in a loop: one copy of its code for both parts.
InterfaceFresnel interfaceFresnel(Principled p, float cosine)
{
    float s = schlickWeight(cosine), solidS = p.solid ? exactWeight(cosine, p.eta) : s;
    InterfaceFresnel f;
    f.dielectric = p.dielectricF0 + (p.dielectricF90 - p.dielectricF0) * solidS;
    f.metal = p.metalF0 + (1.0 - p.metalF0) * s;
    if (!hasFeature(kFeatureTransmission | kFeatureIridescence) || !(p.solid || p.film.x > 0.0)) {
        f.both = p.f0 + (p.f90 - p.f0) * s;
        return f;
    }
    if (hasFeature(kFeatureIridescence) && p.film.x > 0.0) {
        float outside = p.solid && p.eta < 1.0 ? sqrt(max(0.0, refractedCosine2(cosine, p.eta))) : cosine;
        bool ofMetal = !(p.metallic < 1.0);
        bool done;
        do {
            vec3 film = filmReflectance(outside, p.film.y, p.film.z, ofMetal ? p.metalF0 : p.dielectricF0);
            vec3 mixed = mix(ofMetal ? f.metal : f.dielectric, film, p.film.x);
            f.metal = ofMetal ? mixed : f.metal;
            f.dielectric = ofMetal ? f.dielectric : mixed;
            done = ofMetal || !(p.metallic > 0.0);
            ofMetal = true;
        } while (!done);
    }
    f.dielectric = p.solid && solidS >= 1.0 ? vec3(1.0) : f.dielectric;
    f.both = mix(f.dielectric, f.metal, p.metallic);
    return f;
}

// What the interface leaves to the lobes below it, of light at a cosine; `ab` is its fetchAlbedo, `dielectric` the reflectance there. At a
// solid that transmits, whose reflectance has no table, less than that: both directions' shares multiply without a norm.
float passedInterface(Principled p, vec2 ab, vec3 dielectric)
{
    float passed = 1.0 - interfaceAlbedo(p, ab);
    if (hasFeature(kFeatureTransmission) && p.solid) {
        passed = min(passed, 1.0 - greatest(dielectric));
    }
    return passed;
}

#define transmits(p) (hasFeature(kFeatureTransmission) && greatest((p).transmitted) > 0.0)

// Of what the interface samples, the share that it reflects at a microfacet.
float reflectedShare(Principled p, InterfaceFresnel fresnel)
{
    if (!transmits(p)) {
        return 1.0;
    }
    float r = channelMean(fresnel.both), t = channelMean(p.transmitted * (1.0 - fresnel.dielectric));
    return r + t > 0.0 ? r / (r + t) : 1.0;
}

float sheenAlbedoAt(Principled p, float cosine) { return fetchSheenAlbedo(p.sheenRow, cosine); }

float coatAlbedoAt(Principled p, float cosine)
{
    vec2 ab = fetchAlbedo(p.coatRow, cosine);
    return kCoatF0 * ab.x + ab.y;
}

// What the coat takes from what is below, of light from w. A coat that is tilted so much that it reflects w into the surface takes nothing:
// on real bumps that light meets the coat again, which passes nearly all of it (tests/MEASUREMENTS.md).
float takenByCoat(Principled p, vec3 w, float albedo)
{
    return dot(reflectAbout(w, p.coatFrame.z), p.ng) * dot(w, p.ng) > 0.0 ? p.coat * albedo : 0.0;
}

// What coat and sheen leave to what is below, of light from a direction.
float passedLayers(Principled p, float taken, float sheenAlbedo)
{
    float passed = 1.0;
    if (hasFeature(kFeatureClearcoat)) {
        passed *= 1.0 - taken;
    }
    if (hasFeature(kFeatureSheen)) {
        passed *= max(0.0, 1.0 - p.sheenMost * sheenAlbedo);
    }
    return passed;
}

void setCoat(inout Principled p, PrincipledInput m, vec3 wo)
{
    p.coat = m.layers.clearcoat;
    float alpha = m.layers.clearcoatRoughness * m.layers.clearcoatRoughness;
    p.coatSmooth = alpha < kMinAlpha;
    p.coatAlpha = vec2(max(alpha, kMinAlpha));
    p.coatRow = albedoRow(alpha);
    p.coatFrame = makeFrame(dot(m.coatNormal, wo) > 0.0 ? m.coatNormal : vec3(0.0, 0.0, 1.0));
    p.coatAlbedo = coatAlbedoAt(p, dot(p.coatFrame.z, wo));
    p.ng = m.ng;
}

void setSheen(inout Principled p, PrincipledInput m, vec3 wo)
{
    float roughness = max(m.layers.sheenRoughness, kMinSheenRoughness);
    p.sheen = m.layers.sheenRoughness >= kMinSheenRoughness ? m.layers.sheenColor : vec3(0.0);
    p.sheenMost = greatest(p.sheen);
    p.sheenAlpha = roughness * roughness;
    p.sheenRow = albedoRow(p.sheenAlpha);
    p.sheenAlbedo = sheenAlbedoAt(p, wo.z);
}

void setTransmission(inout Principled p, PrincipledInput m)
{
    p.solid = m.layers.transmission > 0.0 && m.layers.medium != 0u;
    p.eta = p.solid && abs(m.eta - 1.0) >= kMinEtaStep ? m.eta : 1.0;
    if (p.solid && p.eta == 1.0) {
        // No interface: Schlick's F90, and with it multiple scattering, would make a rough ball of index 1 visible.
        p.isSmooth = true;
        p.dielectricF0 = vec3(0.0);
        p.dielectricF90 = 0.0;
        p.f0 = m.baseColor * m.data.metallic;
        p.f90 = m.data.metallic;
    }
    float share = p.isSmooth && !p.solid && m.passesStraight ? 0.0 : m.layers.transmission;
    share *= m.layers.scattersThin != 0u ? 1.0 - m.layers.diffuseTransmission : 1.0;
    p.transmitted = m.baseColor * share * (1.0 - m.data.metallic);
    p.glass = hasFeature(kFeatureRoughTransmission) && !p.isSmooth ? share : 0.0;
}

// What single scattering loses of light at a direction on the upper side, where the index beyond over that before is eta. `ab`: fetchAlbedo
// there. A thin wall transmits by the lobe of its reflection.
vec3 lostByGlass(Principled p, vec2 ab, float cosine, float eta)
{
    return p.solid ? lostLight(fetchGlassAlbedo(p.scatteredAlpha, eta, cosine), p.dielectricF0, p.dielectricF90) : vec3(1.0 - ab.x - ab.y);
}

// Sets the lobes of light that glass scatters more than once, and returns the share lost of light from wo. `reflected`, `through`: their
// albedos. Those of a thin wall's reflection are in `scattered`; `fms` is the share of lost light there.
vec3 setGlass(inout Principled p, vec2 ab, vec2 average, vec3 fms, float cosine, out vec3 reflected, out vec3 through)
{
    vec3 lost = lostByGlass(p, ab, cosine, p.eta), reflects = fms;
    vec3 averageLost = vec3(max(1.0 - average.x - average.y, 1e-6)), averageBeyond = averageLost;
    reflected = vec3(0.0);
    if (p.solid) {
        vec4 here = fetchAverageGlassAlbedo(p.scatteredAlpha, p.eta), beyond = fetchAverageGlassAlbedo(p.scatteredAlpha, 1.0 / p.eta);
        averageLost = max(lostLight(here.xyz, p.dielectricF0, p.dielectricF90), 1e-6);
        averageBeyond = max(lostLight(beyond.xyz, p.dielectricF0, p.dielectricF90), 1e-6);
        reflects = glassReflects(p.eta, averageLost, averageBeyond, p.eta > 1.0 ? here.w : beyond.w);
        reflected = reflects * lost * (p.glass * (1.0 - p.metallic));
    }
    through = (1.0 - reflects) * lost * p.transmitted;
    p.glassAbove = reflected / (kPi * averageLost);
    p.glassBelow = through / (kPi * p.eta * p.eta * averageBeyond);
    return lost;
}

// `wo`: z above 0.
Principled makePrincipled(PrincipledInput m, vec3 wo)
{
    PrincipledData data = m.data;
    Principled p;
    float alpha = data.roughness * data.roughness, tableAlpha = alpha;
    p.alpha = vec2(alpha);
    if (hasFeature(kFeatureAnisotropy)) {
        float strength = m.layers.anisotropy;
        p.alpha.x = mix(alpha, 1.0, strength * strength);
        tableAlpha = sqrt(0.5 * (p.alpha.x * p.alpha.x + alpha * alpha));
    }
    p.isSmooth = p.alpha.x < kMinAlpha;
    p.alpha = max(p.alpha, kMinAlpha);
    float reflectance = data.reflectance;
    if (hasFeature(kFeatureTransmission) && m.layers.transmission > 0.0 && m.layers.medium != 0u) {
        reflectance = (m.eta - 1.0) * (m.eta - 1.0) / ((m.eta + 1.0) * (m.eta + 1.0));
    }
    vec3 dielectric = min(reflectance * data.specularColor, vec3(1.0)) * data.specular;
    p.f0 = mix(dielectric, m.baseColor, data.metallic);
    p.f90 = mix(data.specular, 1.0, data.metallic);
    p.dielectricF0 = dielectric;
    p.dielectricF90 = data.specular;
    p.metalF0 = m.baseColor;
    p.metallic = data.metallic;
    p.transmitted = vec3(0.0);
    p.film = vec3(0.0);
    p.solid = false;
    p.glass = 0.0;
    p.glassAbove = p.glassBelow = vec3(0.0);
    p.eta = 1.0;
    if (hasFeature(kFeatureTransmission)) {
        setTransmission(p, m);
    }
    if (hasFeature(kFeatureIridescence)) {
        p.film = vec3(m.layers.iridescence, m.layers.iridescenceIor, m.filmThickness);
    }
    p.fresnel = interfaceFresnel(p, wo.z);
    vec3 tableF0 = p.f0, tableDielectric = p.dielectricF0, tableMetal = m.baseColor;
    if (hasFeature(kFeatureIridescence)) {
        if (p.film.x > 0.0) {
            // The tables are linear in F0: those that Schlick needs to give the film's reflectance at wo.
            float s = schlickWeight(wo.z), rest = 1.0 - min(s, 0.999);
            tableDielectric = clamp((p.fresnel.dielectric - p.dielectricF90 * s) / rest, 0.0, 1.0);
            tableMetal = clamp((p.fresnel.metal - s) / rest, 0.0, 1.0);
            tableF0 = mix(tableDielectric, tableMetal, data.metallic);
        }
    }
    p.baseReflectance = vec2(greatest(tableDielectric), p.dielectricF90);
    p.row = albedoRow(tableAlpha);
    p.scatteredAlpha = max(tableAlpha, kMinAlpha);
    vec2 ab = fetchAlbedo(p, wo);
    vec2 average = fetchAverageAlbedo(p);
    p.baseFms = multipleScatteringFresnel(average, p.baseReflectance.xxx, p.baseReflectance.y).x;
    // Mixed like the two BSDFs, for it is convex in F0: of the mixed F0, a white half-metal of roughness 1 would reflect .78 of the light.
    vec3 dielectricFms = multipleScatteringFresnel(average, tableDielectric, p.dielectricF90);
    vec3 fms = mix(dielectricFms * (p.solid ? 1.0 - p.glass : 1.0), multipleScatteringFresnel(average, tableMetal, 1.0), data.metallic);
    vec3 scattered = fms * (1.0 - ab.x - ab.y);
    float below = (1.0 - data.metallic) * passedInterface(p, ab, p.fresnel.dielectric);
    vec3 through = vec3(0.0);
    vec3 diffuse = m.baseColor * below;
    if (hasFeature(kFeatureTransmission)) {
        diffuse *= 1.0 - m.layers.transmission;
    }
    if (hasFeature(kFeatureDiffuseTransmission)) {
        bool scatters = m.layers.scattersThin != 0u;
        float left = hasFeature(kFeatureTransmission) ? 1.0 - m.layers.transmission : 1.0;
        left = scatters ? m.layers.transmission : left;
        vec3 spread = m.layers.diffuseTransmissionColor * (below * left * m.layers.diffuseTransmission);
        through = spread * (1.0 - m.layers.backscattered);
        diffuse = diffuse * (scatters ? 1.0 : 1.0 - m.layers.diffuseTransmission) + spread * m.layers.backscattered;
    }
    p.coat = p.sheenMost = p.coatAlbedo = p.sheenAlbedo = 0.0;
    if (hasFeature(kFeatureClearcoat)) {
        setCoat(p, m, wo);
    }
    if (hasFeature(kFeatureSheen)) {
        setSheen(p, m, wo);
    }
    float taken = 0.0;
    if (hasFeature(kFeatureClearcoat)) {
        taken = takenByCoat(p, wo, p.coatAlbedo);
    }
    p.passed = passedLayers(p, taken, p.sheenAlbedo);
    vec3 albedo = singleScatteringAlbedo(ab, tableF0, p.f90);
    if (hasFeature(kFeatureTransmission)) {
        albedo = p.solid ? p.fresnel.both : albedo;
        albedo += p.transmitted * (1.0 - p.fresnel.dielectric);
    }
    vec3 furtherAbove = scattered, furtherBelow = vec3(0.0);
    if (hasFeature(kFeatureRoughTransmission) && p.glass > 0.0) {
        vec3 reflected;
        vec3 lost = setGlass(p, ab, average, dielectricFms, wo.z, reflected, furtherBelow);
        albedo *= 1.0 - p.glass * lost;
        furtherAbove += reflected;
    }
    vec4 weights = vec4(channelMean(albedo), channelMean(furtherAbove + diffuse), 0.0, channelMean(furtherBelow + through));
    float sheenWeight = 0.0;
    if (hasFeature(kFeatureClearcoat)) {
        weights *= p.passed;
        weights.z = p.coat * p.coatAlbedo;
    }
    if (hasFeature(kFeatureSheen)) {
        weights *= hasFeature(kFeatureClearcoat) ? 1.0 : p.passed;
        sheenWeight = channelMean(p.sheen) * min(p.sheenAlbedo, 1.0);
    }
    float sum = max(weights.x + weights.y + weights.z + weights.w + sheenWeight, 1e-30);
    // What glass loses is known so well that its lobes need no least probability. A path within it meets it tens of times, and would lose
    // that share of its samples each time.
    float least = hasFeature(kFeatureRoughTransmission) ? kMinLobeProbability * (1.0 - p.glass) : kMinLobeProbability;
    vec4 probability = mix(clamp(weights / sum, least, 1.0), vec4(0.0), lessThanEqual(weights, vec4(0.0)));
    p.pSheen = sheenWeight > 0.0 ? max(sheenWeight / sum, kMinLobeProbability) : 0.0;
    float scale = 1.0 / max(probability.x + probability.y + probability.z + probability.w + p.pSheen, 1e-30);
    p.pInterface = probability.x * scale;
    p.pDiffuse = probability.y * scale;
    p.pCoat = probability.z * scale;
    p.pThrough = probability.w * scale;
    p.pSheen *= scale;
    float diffuseScale = 1.0 / (kPi * (p.solid ? 1.0 : max(1.0 - interfaceAlbedo(p, average), 1e-6)));
    p.scattered = scattered / (kPi * max(1.0 - average.x - average.y, 1e-6));
    // 1e-30: a black lobe gives 0, not 0 / 0.
    p.scatteredShare = channelMean(furtherAbove) / max(channelMean(furtherAbove + diffuse), 1e-30);
    p.throughShare = channelMean(furtherBelow) / max(channelMean(furtherBelow + through), 1e-30);
    p.diffuse = diffuse * diffuseScale;
    p.diffuseThrough = through * diffuseScale;
    if (hasFeature(kFeatureDiffuseTransmission) && m.layers.medium != 0u) {
        // Into another index, as at a smooth interface; otherwise light that enters by one lobe and leaves by the other is gained or lost.
        p.eta = m.eta;
        p.diffuseThrough /= m.eta * m.eta;
    }
    return p;
}

// Whether all lobes are delta.
bool isDeltaOnly(Principled p)
{
    return p.isSmooth && p.pDiffuse + p.pSheen + p.pThrough + (p.coatSmooth ? 0.0 : p.pCoat) == 0.0;
}

// GGX lobes from this alpha on scatter in so many directions that a guide helps to choose among them.
const float kBroadAlpha = 0.25;

// How likely a lobe is chosen that scatters in many directions.
float broadShare(Principled p)
{
    float broad = p.pDiffuse + p.pSheen + p.pThrough + (min(p.alpha.x, p.alpha.y) >= kBroadAlpha ? p.pInterface : 0.0);
    return hasFeature(kFeatureClearcoat) && p.coatAlpha.x >= kBroadAlpha ? broad + p.pCoat : broad;
}

// What evalAbove and evalBelow need.
struct InterfaceEval {
    vec3 h;                        // the microfacet's normal; z <= 0 if there is none
    InterfaceFresnel fresnel;      // there
    vec2 ab;                       // fetchAlbedo at wi
    vec3 dielectric;               // of a solid: reflectance at wi
};

// The interface's Fresnel reflectance at h and, of a solid, at wi too: in a loop, for one copy of its code.
InterfaceEval evalInterface(Principled p, vec3 wo, vec3 wi)
{
    bool above = wi.z > 0.0;
    vec3 mirrored = vec3(wi.xy, abs(wi.z));
    InterfaceEval e;
    e.h = halfVector(wo, mirrored);
    if (hasFeature(kFeatureTransmission) && !above && p.solid) {
        e.h = refractionNormal(wo, wi, p.eta);
    }
    e.ab = fetchAlbedo(p, mirrored);
    bool atWi = false, done;
    do {
        InterfaceFresnel fresnel = interfaceFresnel(p, atWi ? mirrored.z : dot(wo, e.h));
        if (!atWi) {
            e.fresnel = fresnel;
        }
        e.dielectric = fresnel.dielectric;
        done = atWi || !p.solid;
        atWi = true;
    } while (!done);
    return e;
}

// Light that leaves below the surface. wi.z < 0.
BsdfEval evalBelow(Principled p, InterfaceEval e, vec3 wo, vec3 wi)
{
    BsdfEval result = BsdfEval(vec3(0.0), 0.0);
    if (hasFeature(kFeatureDiffuseTransmission)) {
        result = BsdfEval(p.diffuseThrough * passedInterface(p, e.ab, e.dielectric) * -wi.z, p.pThrough * pdfCosineHemisphere(-wi.z));
    }
    if (hasFeature(kFeatureRoughTransmission) && p.glass > 0.0) {
        result.f += p.glassBelow * lostByGlass(p, e.ab, -wi.z, 1.0 / p.eta) * -wi.z;
        result.pdf = p.pThrough * mix(pdfCosineHemisphere(-wi.z), pdfMultipleScattering(-wi.z, p.scatteredAlpha), p.throughShare);
    }
    if (transmits(p) && !p.isSmooth && e.h.z > 0.0) {
        vec3 mirrored = vec3(wi.xy, -wi.z);
        float share = (1.0 - reflectedShare(p, e.fresnel)) * p.pInterface;
        float f = p.solid ? evalGgxTransmission(wo, wi, e.h, p.alpha, p.eta) : evalGgx(wo, mirrored, p.alpha);
        float pdf = p.solid ? pdfGgxTransmission(wo, wi, e.h, p.alpha, p.eta) : pdfGgx(wo, mirrored, p.alpha);
        result.f += p.transmitted * (1.0 - e.fresnel.dielectric) * f;
        result.pdf += share * pdf;
    }
    return result;
}

float pdfDiffuse(Principled p, float cosine)
{
    return mix(pdfCosineHemisphere(cosine), pdfMultipleScattering(cosine, p.scatteredAlpha), p.scatteredShare);
}

BsdfEval evalAbove(Principled p, InterfaceEval e, vec3 wo, vec3 wi)
{
    vec3 diffuse = p.scattered * (1.0 - e.ab.x - e.ab.y) + p.diffuse * passedInterface(p, e.ab, e.dielectric);
    if (hasFeature(kFeatureRoughTransmission) && p.glass > 0.0 && p.solid) {
        diffuse += p.glassAbove * lostByGlass(p, e.ab, wi.z, p.eta);
    }
    BsdfEval result = BsdfEval(diffuse * wi.z, p.pDiffuse * pdfDiffuse(p, wi.z));
    if (!p.isSmooth) {
        result.f += e.fresnel.both * evalGgx(wo, wi, p.alpha);
        result.pdf += p.pInterface * reflectedShare(p, e.fresnel) * pdfGgx(wo, wi, p.alpha);
    }
    return result;
}

// All lobes that are not delta.
BsdfEval evalPrincipled(Principled p, vec3 wo, vec3 wi)
{
    bool above = wi.z > 0.0;
    InterfaceEval e = evalInterface(p, wo, wi);
    BsdfEval result;
    if (above || !hasFeature(kFeatureTransmission | kFeatureDiffuseTransmission)) {
        result = evalAbove(p, e, wo, wi);
    } else {
        result = evalBelow(p, e, wo, wi);
    }
    float taken = 0.0, sheenAlbedo = 0.0;
    vec3 coatWi = wi;
    if (hasFeature(kFeatureClearcoat)) {
        coatWi = frameFromWorld(p.coatFrame, wi);
        taken = takenByCoat(p, wi, coatAlbedoAt(p, abs(coatWi.z)));
    }
    if (hasFeature(kFeatureSheen)) {
        sheenAlbedo = sheenAlbedoAt(p, abs(wi.z));
    }
    if (hasFeature(kFeatureClearcoat | kFeatureSheen)) {
        result.f *= min(p.passed, passedLayers(p, taken, sheenAlbedo));
    }
    if (hasFeature(kFeatureSheen) && above && p.sheenMost > 0.0) {
        float left = hasFeature(kFeatureClearcoat) ? min(1.0 - takenByCoat(p, wo, p.coatAlbedo), 1.0 - taken) : 1.0;
        result.f += p.sheen * (left * evalSheen(wo, wi, p.sheenAlpha) * sheenScale(p.sheenAlbedo, sheenAlbedo));
        result.pdf += p.pSheen * kPdfSheen;
    }
    if (hasFeature(kFeatureClearcoat) && above && coatWi.z > 0.0 && p.coat > 0.0 && !p.coatSmooth) {
        vec3 coatWo = frameFromWorld(p.coatFrame, wo);
        float fresnel = kCoatF0 + (1.0 - kCoatF0) * schlickWeight(dot(coatWo, halfVector(coatWo, coatWi)));
        result.f += p.coat * fresnel * evalGgx(coatWo, coatWi, p.coatAlpha);
        result.pdf += p.pCoat * pdfGgx(coatWo, coatWi, p.coatAlpha);
    }
    return result;
}

// Which lobe u, in [0, 1), falls to; u becomes its place in the lobe's share.
uint chooseLobe(Principled p, inout float u)
{
    uint lobe = kLobeInterface;
    float share = p.pInterface;
    // The order ends with lobes that always exist, so that rounding cannot choose one of probability 0.
    if (hasFeature(kFeatureClearcoat) && u < p.pCoat) {
        lobe = kLobeCoat;
        share = p.pCoat;
    } else {
        u -= hasFeature(kFeatureClearcoat) ? p.pCoat : 0.0;
        if (hasFeature(kFeatureSheen) && u < p.pSheen) {
            lobe = kLobeSheen;
            share = p.pSheen;
        } else {
            u -= hasFeature(kFeatureSheen) ? p.pSheen : 0.0;
            if (hasFeature(kFeatureDiffuseTransmission | kFeatureRoughTransmission) && u < p.pThrough) {
                lobe = kLobeThrough;
                share = p.pThrough;
            } else {
                u -= hasFeature(kFeatureDiffuseTransmission | kFeatureRoughTransmission) ? p.pThrough : 0.0;
                if (!(u < p.pInterface)) {
                    u -= p.pInterface;
                    lobe = kLobeDiffuse;
                    share = p.pDiffuse;
                }
            }
        }
    }
    u = clamp(u / max(share, 1e-30), 0.0, 0.99999994);
    return lobe;
}

// Sampled at a microfacet h on wo's side: whether it transmits, and the direction.
vec3 sampleInterface(Principled p, InterfaceFresnel fresnel, vec3 wo, vec3 h, float u, out bool below)
{
    float cosine = dot(wo, h);
    below = transmits(p) && u >= reflectedShare(p, fresnel);
    vec3 mirrored = 2.0 * cosine * h - wo;
    vec3 through = p.solid ? refractThrough(wo, h, abs(p.eta - 1.0) >= kMinEtaStep ? p.eta : 1.0) : vec3(mirrored.xy, -mirrored.z);
    return below ? through : mirrored;
}

// The weight of a delta lobe's direction is its reflectance or transmittance over its probability.
BsdfSample sampleDelta(Principled p, uint lobe, vec3 wo, float u)
{
    if (hasFeature(kFeatureClearcoat) && lobe == kLobeCoat) {
        float cosine = dot(wo, p.coatFrame.z);
        float fresnel = kCoatF0 + (1.0 - kCoatF0) * schlickWeight(cosine);
        return BsdfSample(2.0 * cosine * p.coatFrame.z - wo, vec3(p.coat * fresnel / p.pCoat), 0.0, 1.0, kBsdfDelta);
    }
    bool below;
    vec3 wi = sampleInterface(p, p.fresnel, wo, vec3(0.0, 0.0, 1.0), u, below);
    float share = reflectedShare(p, p.fresnel);
    if (!below) {
        return BsdfSample(wi, p.fresnel.both * p.passed / (p.pInterface * share), 0.0, 1.0, kBsdfDelta);
    }
    float eta = p.solid ? p.eta : 1.0;
    vec3 weight = p.transmitted * (1.0 - p.fresnel.dielectric) * p.passed / (p.pInterface * (1.0 - share) * eta * eta);
    return BsdfSample(wi, weight, 0.0, eta, kBsdfDelta | kBsdfTransmission);
}

// uLobe chooses the lobe. Unweighted unless delta: the weight is that of all lobes together, divided by the density of the mixture.
BsdfSample samplePrincipledDirection(Principled p, vec3 wo, vec2 u, float uLobe)
{
    uint lobe = chooseLobe(p, uLobe);
    if ((lobe == kLobeInterface && p.isSmooth) || (hasFeature(kFeatureClearcoat) && lobe == kLobeCoat && p.coatSmooth)) {
        return sampleDelta(p, lobe, wo, uLobe);
    }
    bool below = false;
    vec3 wi;
    if (hasFeature(kFeatureClearcoat) && lobe == kLobeCoat) {
        wi = worldFromFrame(p.coatFrame, sampleGgx(frameFromWorld(p.coatFrame, wo), p.coatAlpha, u));
    } else if (hasFeature(kFeatureSheen) && lobe == kLobeSheen) {
        wi = sampleSheen(u);
    } else if (lobe == kLobeInterface) {
        vec3 h = sampleVisibleNormal(wo, p.alpha, u);
        InterfaceFresnel fresnel = p.fresnel;
        if (transmits(p)) {
            fresnel = interfaceFresnel(p, dot(wo, h));
        }
        wi = sampleInterface(p, fresnel, wo, h, uLobe, below);
    } else {
        below = lobe == kLobeThrough;
        float share = below ? (hasFeature(kFeatureRoughTransmission) ? p.throughShare : 0.0) : p.scatteredShare;
        wi = uLobe < share ? sampleMultipleScattering(u, p.scatteredAlpha) : sampleCosineHemisphere(u);
        wi.z = below ? -wi.z : wi.z;
    }
    bool valid = below ? wi.z < 0.0 : wi.z > 0.0;
    if (!valid) {
        return BsdfSample(wi, vec3(0.0), 0.0, 1.0, 0u);
    }
    bool bends = lobe == kLobeThrough || p.solid;
    float eta = below && bends ? p.eta : 1.0;
    return BsdfSample(wi, vec3(0.0), 0.0, eta, kBsdfUnweighted | (below ? kBsdfTransmission : 0u));
}

BsdfSample samplePrincipled(Principled p, vec3 wo, vec2 u, float uLobe)
{
    BsdfSample s = samplePrincipledDirection(p, wo, u, uLobe);
    return weightSample(s, evalPrincipled(p, wo, s.wi));
}

#endif
