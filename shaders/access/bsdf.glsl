// The BSDF of a material at a point: the one place that knows which lobes there are. A new lobe adds its branches here and its file to
// lib/bsdf.
#ifndef GLIM_ACCESS_BSDF
#define GLIM_ACCESS_BSDF

#include "interaction.glsl"
#include "lib/bsdf/dielectric.glsl"
#include "lib/bsdf/lambert.glsl"
#include "lib/bsdf/mirror.glsl"
#include "material.glsl"
#include "principled.glsl"

struct Bsdf {
    uint lobe;    // kLambert, kMirror, kDielectric, kPrincipled
    vec3 color;   // albedo, reflectance at normal incidence, or tint
    float eta;    // dielectric: index beyond the interface over that on wo's side
    Frame frame;  // z: the shading normal on wo's side
    vec3 ng;      // unit, on wo's side
    Principled principled;
};

bool isDielectric(uint lobe) { return hasFeature(kFeatureDielectric) && lobe == kDielectric; }
bool isMirror(uint lobe) { return hasFeature(kFeatureMirror) && lobe == kMirror; }
bool isPrincipled(uint lobe) { return hasFeature(kFeaturePrincipled) && lobe == kPrincipled; }

// For a dielectric the shading normal alone decides on which side wo is, and so which index is in front, even against the geometric normal.
// If the geometric normal decided, light could enter by one shading normal and be totally reflected by the others for ever: a furnace of
// smooth gems with normals 20 degrees off their faces fell to .984. By this rule light that passes wrongly through a wall soon passes back,
// and the furnace gives 1.
Bsdf makeBsdf(SurfaceInteraction si, SurfaceMaterial material, vec3 wo)
{
    MaterialData data = material.data;
    bool dielectric = isDielectric(data.lobe);
    bool behind = dot(si.ns, wo) < 0.0;
    float eta = si.front != behind ? data.ior : 1.0 / data.ior;
    vec3 ns = dielectric ? faceForward(si.ns, wo) : visibleNormal(si, wo);
    Bsdf bsdf;
    bsdf.lobe = data.lobe;
    bsdf.color = data.baseColor;
    bsdf.eta = dielectric ? eta : 1.0;
    bsdf.ng = si.ng;
    if (isPrincipled(data.lobe)) {
        ns = reflectingNormal(ns, si.ng, wo);
        bsdf.principled = makePrincipled(material.principled, data.baseColor, dot(ns, wo));
    }
    bsdf.frame = makeFrame(ns);
    return bsdf;
}

// Whether any lobe can be evaluated, so that sampling lights makes sense.
bool hasNonDelta(Bsdf bsdf)
{
    bool principled = isPrincipled(bsdf.lobe) && !(bsdf.principled.smooth_ && bsdf.principled.specularProbability == 1.0);
    return bsdf.lobe == kLambert || principled;
}

// All lobes that are not delta. Directions in world space, unit, away from the surface.
BsdfEval evalBsdf(Bsdf bsdf, vec3 wo, vec3 wi)
{
    vec3 local = frameFromWorld(bsdf.frame, wi);
    bool reflects = hasNonDelta(bsdf) && local.z > 0.0 && dot(wi, bsdf.ng) > 0.0;
    if (isPrincipled(bsdf.lobe) && reflects) {
        return evalPrincipled(bsdf.principled, frameFromWorld(bsdf.frame, wo), local);
    }
    return BsdfEval(reflects ? evalLambert(bsdf.color, local) : vec3(0.0), reflects ? pdfLambert(local) : 0.0);
}

// If the sampled direction points through the geometric surface, a mirror reflects about the geometric normal instead, and any other
// surface absorbs the light.
BsdfSample sampleReflection(Bsdf bsdf, vec3 wo, vec2 u, float uLobe)
{
    if (isMirror(bsdf.lobe)) {
        BsdfSample mirrored = sampleMirror(bsdf.color, wo, bsdf.frame.z);
        return dot(mirrored.wi, bsdf.ng) > 0.0 ? mirrored : sampleMirror(bsdf.color, wo, bsdf.ng);
    }
    BsdfSample s;
    if (isPrincipled(bsdf.lobe)) {
        s = samplePrincipled(bsdf.principled, frameFromWorld(bsdf.frame, wo), u, uLobe);
    } else {
        s = sampleLambert(bsdf.color, u);
    }
    s.wi = worldFromFrame(bsdf.frame, s.wi);
    s.weight = dot(s.wi, bsdf.ng) > 0.0 ? s.weight : vec3(0.0);
    return s;
}

// Chooses a lobe by uLobe and a direction by u, both in [0, 1).
BsdfSample sampleBsdf(Bsdf bsdf, vec3 wo, vec2 u, float uLobe)
{
    return isDielectric(bsdf.lobe) ? sampleDielectric(bsdf.color, bsdf.eta, wo, bsdf.frame.z, uLobe) : sampleReflection(bsdf, wo, u, uLobe);
}

#endif
