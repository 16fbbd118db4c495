// The BSDF of a material at a point: the one place that knows which lobes there are. A new lobe adds its branches here and its file to
// lib/bsdf.
#ifndef GLIM_ACCESS_BSDF
#define GLIM_ACCESS_BSDF

#include "interaction.glsl"
#include "lib/octahedral.glsl"
#include "lib/bsdf/dielectric.glsl"
#include "lib/bsdf/lambert.glsl"
#include "lib/bsdf/mirror.glsl"
#include "material.glsl"
#include "principled.glsl"

struct Bsdf {
    uint type;    // kLambert ...
    vec3 color;   // albedo, reflectance at normal incidence, or tint
    float eta;    // dielectric: index beyond the interface over that on wo's side
    Frame frame;  // z: the shading normal on wo's side
    vec3 ng;      // unit, on wo's side
    uint medium;  // that the surface encloses, or 0
    Principled principled;
};

#define isDielectric(type) (hasFeature(kFeatureDielectric) && (type) == kDielectric)
#define isMirror(type) (hasFeature(kFeatureMirror) && (type) == kMirror)
#define isPrincipled(type) (hasFeature(kFeaturePrincipled) && (type) == kPrincipled)
#define scattersNothing(type) (hasFeature(kFeatureUnlit) && (type) == kUnlit)

// The frame whose x axis is the tangent. A tangent within 1e-6 rad of n, where float has lost its direction, gives any frame.
Frame makeFrame(vec3 n, vec3 tangent)
{
    vec3 x = tangent - n * dot(n, tangent);
    float square = dot(x, x);
    if (!(square > 1e-12 * dot(tangent, tangent))) {
        return makeFrame(n);
    }
    x /= sqrt(square);
    return Frame(x, cross(n, x), n);
}

// wo in the shading frame, kept out of the surface's plane, because lobes divide by its cosine.
vec3 outgoingInFrame(Frame frame, vec3 wo)
{
    vec3 local = frameFromWorld(frame, wo);
    return vec3(local.xy, max(local.z, 1e-6));
}

Principled makePrincipled(SurfaceInteraction si, SurfaceMaterial material, Frame frame, vec3 wo)
{
    PrincipledInput m;
    m.data = material.principled;
    m.layers = material.layers;
    m.baseColor = material.data.baseColor;
    m.filmThickness = material.filmThickness;
    m.eta = material.iors.y / material.iors.x;
    m.passesStraight = hasFeature(kFeatureThinWalls) && passesStraight(material.data);
    vec3 coatNormal = dot(material.coatNormal, wo) > 0.0 ? material.coatNormal : si.ng;
    m.coatNormal = frameFromWorld(frame, coatNormal);
    m.ng = frameFromWorld(frame, si.ng);
    return makePrincipled(m, outgoingInFrame(frame, wo));
}

// For a dielectric the shading normal alone decides on which side wo is, and so which index is in front, even against the geometric normal.
// If the geometric normal decided, light could enter by one shading normal and be totally reflected by the others for ever: a furnace of
// smooth gems with normals 20 degrees off their faces fell to .984. By this rule light that passes wrongly through a wall soon passes back,
// and the furnace gives 1.
Bsdf makeBsdf(SurfaceInteraction si, SurfaceMaterial material, vec3 wo)
{
    MaterialData data = material.data;
    bool dielectric = isDielectric(data.type);
    bool behind = dot(si.ns, wo) < 0.0;
    float eta = behind ? material.iors.x / material.iors.y : material.iors.y / material.iors.x;
    vec3 ns = dielectric ? faceForward(si.ns, wo) : visibleNormal(si, wo);
    Bsdf bsdf;
    bsdf.type = data.type;
    bsdf.color = data.baseColor;
    bsdf.eta = dielectric ? eta : 1.0;
    bsdf.ng = si.ng;
    if (isPrincipled(data.type)) {
        ns = reflectingNormal(ns, si.ng, wo);
    }
    bsdf.frame = makeFrame(ns);
    bsdf.medium = getMedium(material);
    if (isPrincipled(data.type)) {
        if (hasFeature(kFeatureAnisotropy) && material.layers.anisotropy > 0.0) {
            bsdf.frame = makeFrame(ns, material.tangent);
        }
        bsdf.principled = makePrincipled(si, material, bsdf.frame, wo);
    }
    return bsdf;
}

// Whether any lobe can be evaluated, so that sampling lights makes sense.
bool hasNonDelta(Bsdf bsdf)
{
    bool principled = isPrincipled(bsdf.type) && !isDeltaOnly(bsdf.principled);
    return bsdf.type == kLambert || principled;
}

// How likely a lobe is chosen that scatters in many directions.
float broadShare(Bsdf bsdf)
{
    return isPrincipled(bsdf.type) ? broadShare(bsdf.principled) : bsdf.type == kLambert ? 1.0 : 0.0;
}

// Whether a lobe that is not delta transmits.
#define transmitsDiffusely(bsdf) \
    (hasFeature(kFeatureTransmission | kFeatureDiffuseTransmission) && isPrincipled((bsdf).type) && hasNonDelta(bsdf))

// PathState::normal of a vertex, for the choice of lights.
uint encodeReceiverNormal(Bsdf bsdf)
{
    return !hasFeature(kFeatureLightTree) && !kGuided ? 0u : transmitsDiffusely(bsdf) ? kNoReceiverNormal : encodeNormal(bsdf.frame.z);
}

vec3 decodeReceiverNormal(uint normal)
{
    return normal == kNoReceiverNormal ? vec3(0.0) : decodeNormal(normal);
}

// `local`: wi in the shading frame. `outwards`: its cosine against bsdf.ng.
BsdfEval evalInFrame(Bsdf bsdf, vec3 wo, vec3 local, float outwards)
{
    bool reflects = hasNonDelta(bsdf) && local.z > 0.0 && outwards > 0.0;
    bool through = transmitsDiffusely(bsdf) && local.z < 0.0 && outwards < 0.0;
    if (isPrincipled(bsdf.type) && (reflects || through)) {
        return evalPrincipled(bsdf.principled, outgoingInFrame(bsdf.frame, wo), local);
    }
    return BsdfEval(reflects ? evalLambert(bsdf.color, local) : vec3(0.0), reflects ? pdfLambert(local) : 0.0);
}

// All lobes that are not delta. Directions in world space, unit, away from the surface.
BsdfEval evalBsdf(Bsdf bsdf, vec3 wo, vec3 wi)
{
    return evalInFrame(bsdf, wo, frameFromWorld(bsdf.frame, wi), dot(wi, bsdf.ng));
}

// If the sampled direction is on the wrong side of the geometric surface, a mirror reflects about the geometric normal instead, and any other
// surface absorbs the light. `local`: wi in the shading frame, of a sample that is still unweighted.
BsdfSample sampleReflection(Bsdf bsdf, vec3 wo, vec2 u, float uLobe, inout vec3 local)
{
    if (isMirror(bsdf.type)) {
        BsdfSample mirrored = sampleMirror(bsdf.color, wo, bsdf.frame.z);
        return dot(mirrored.wi, bsdf.ng) > 0.0 ? mirrored : sampleMirror(bsdf.color, wo, bsdf.ng);
    }
    BsdfSample s;
    if (isPrincipled(bsdf.type)) {
        s = samplePrincipledDirection(bsdf.principled, outgoingInFrame(bsdf.frame, wo), u, uLobe);
    } else {
        s = sampleLambert(bsdf.color, u);
    }
    local = s.wi;
    s.wi = worldFromFrame(bsdf.frame, local);
    float outwards = (s.flags & kBsdfTransmission) != 0u ? -dot(s.wi, bsdf.ng) : dot(s.wi, bsdf.ng);
    s.weight = outwards > 0.0 && !scattersNothing(bsdf.type) ? s.weight : vec3(0.0);
    return s;
}

// sampleBsdf without evaluating the principled BSDF at the direction: such a sample is still unweighted.
BsdfSample sampleUnweighted(Bsdf bsdf, vec3 wo, vec2 u, float uLobe, out vec3 local)
{
    BsdfSample s;
    local = vec3(0.0);
    if (isDielectric(bsdf.type)) {
        s = sampleDielectric(bsdf.color, bsdf.eta, wo, bsdf.frame.z, uLobe);
    } else {
        s = sampleReflection(bsdf, wo, u, uLobe, local);
    }
    return s;
}

// Chooses a lobe by uLobe and a direction by u, both in [0, 1).
BsdfSample sampleBsdf(Bsdf bsdf, vec3 wo, vec2 u, float uLobe)
{
    vec3 local;
    BsdfSample s = sampleUnweighted(bsdf, wo, u, uLobe, local);
    if (hasFeature(kFeaturePrincipled)) {
        s = weightSample(s, evalInFrame(bsdf, wo, local, dot(s.wi, bsdf.ng)));
    }
    return s;
}

struct BsdfPair {
    BsdfEval light;
    BsdfSample next;
};

// Evaluates the BSDF towards a light and at a sample, `local` in the shading frame, which gets its weight unless it has it: in a loop, for
// one copy of the code of evalPrincipled.
BsdfPair evalBsdfTwice(Bsdf bsdf, vec3 wo, vec3 lightWi, BsdfSample next, vec3 local)
{
    BsdfPair pair;
    pair.next = next;
    bool ofNext = false;
    do {
        vec3 wi = ofNext ? pair.next.wi : lightWi;
        BsdfEval f = evalInFrame(bsdf, wo, ofNext ? local : frameFromWorld(bsdf.frame, lightWi), dot(wi, bsdf.ng));
        if (ofNext) {
            pair.next = weightSample(pair.next, f);
        } else {
            pair.light = f;
        }
        ofNext = !ofNext;
    } while (ofNext);
    return pair;
}

// evalBsdf and sampleBsdf at once.
BsdfPair evalAndSampleBsdf(Bsdf bsdf, vec3 wo, vec3 lightWi, vec2 u, float uLobe)
{
    vec3 local;
    BsdfSample next = sampleUnweighted(bsdf, wo, u, uLobe, local);
    if (!hasFeature(kFeaturePrincipled)) {
        return BsdfPair(evalBsdf(bsdf, wo, lightWi), next);
    }
    return evalBsdfTwice(bsdf, wo, lightWi, next, local);
}

// Which lobe sampleBsdf chooses: kLambert, kMirror or kDielectric, or kPrincipled + kLobeInterface ...
uint sampledLobe(Bsdf bsdf, float uLobe)
{
    return isPrincipled(bsdf.type) ? kPrincipled + chooseLobe(bsdf.principled, uLobe) : bsdf.type;
}

#endif
