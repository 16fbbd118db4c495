// A path's vertex: what happens where a ray meets a surface, or nothing. Both schedules call shadeSurface and shadeMiss; they only
// store, trace and queue. Conditions select values rather than branch: on CPUs each value that differs between two branches costs
// two masked stores (tests/bench/EXPERIMENTS.md).
#ifndef GLIM_ACCESS_PATH_VERTEX
#define GLIM_ACCESS_PATH_VERTEX

#include "direct_light.glsl"
#include "first_hit.glsl"
#include "guided_bsdf.glsl"
#include "lib/mis.glsl"
#include "lib/roulette.glsl"
#include "media.glsl"
#include "next_ray.glsl"

struct VertexResult {
    vec3 emitted;         // emission that the ray itself has hit, times throughput and MIS weight
    uint emittedGroup;    // of lights
    FirstHit firstHit;    // of the camera's ray
    bool hasShadowRay;
    ShadowRay shadowRay;
    uint shadowGroup;     // of the light that it goes to
    bool hasNextRay;
    PathRay ray;          // the next one
    PathState state;      // and its state
    LearnedVertex learned;
};

// The MIS weight of light that a ray has hit, if light sampling has the density lightPdf for it. It is 1 for camera rays and after delta
// lobes.
float misWeightOfHit(PathState state, float lightPdf)
{
    if (!(state.pdf > 0.0)) {
        return 1.0;
    }
    float weight = powerHeuristic(state.pdf, lightPdf);
    noteHitLight(lightPdf, weight);
    return weight;
}

// Environment light that an escaping ray has hit, times throughput and MIS weight.
vec3 shadeMiss(PathRay ray, PathState state)
{
    vec3 environment = state.throughput * weightedEnvironment(ray, state);
    return hasFeature(kFeatureMedia) ? environment * pathTransmittance(ray.media, kInfinity) : environment;
}

uint environmentGroup()
{
    return hasFeature(kFeatureLightGroups) ? lightGroupOf(fetchLight(render.environmentLight).kind) : 0u;
}

float misWeightOfSample(float lightPdf, float bsdfPdf)
{
    return lightPdf > 0.0 ? powerHeuristic(lightPdf, bsdfPdf) : 1.0;
}

// A guided path meets roulette where it arrives.
float computeContinuation(BsdfSample s, vec3 throughput, float etaScale, uint bounce)
{
    return kGuided ? 1.0 : continuationProbability(throughput, etaScale, bounce);
}

// Roulette of a guided path, by the light that it is to bring: throughput times the radiance that is known of the surface it has met, over
// that of the first one (Vorba and Křivánek, "Adjoint-Driven Russian Roulette and Splitting in Light Transport Simulation", 2016), which
// etaScale holds. False if the path ends.
bool survivesArrival(Guide guide, float u, inout PathState state)
{
    if (state.bounce == 0u) {
        state.etaScale /= guide.radiance;
        return true;
    }
    float q = max(kLeastGuidedContinuation, continuationProbability(state.throughput * guide.radiance, state.etaScale, kRouletteBounce));
    state.throughput /= q;
    bool survives = u < q;
    noteArrival(q, survives);
    return survives;
}

// A surface that transmits has none: lights are then sampled from another point than rays leave from.
uint fetchSight(vec3 p, vec3 receiverNormal)
{
    return kGuided && receiverNormal != vec3(0.0) ? fetchGuide(p, receiverNormal).sight : 0u;
}

// At a surface. Also tells light contexts what it knows of lights.
Guide fetchGuide(Bsdf bsdf, inout LightContext context)
{
    bool transmits = context.receiverNormal == vec3(0.0);
    Guide guide = fetchGuide(context.p, transmits ? bsdf.frame.z : context.receiverNormal);
    guide.share *= broadShare(bsdf);
    context.sight = transmits ? 0u : guide.sight;
    return guide;
}

LightSample sampleDirectLight(SampleId id, LightContext context, uint bounce, out LightChoice choice, out uint group)
{
    choice = chooseLight(id, context, bounce);
    group = 0u;
    if (kGuided && !(choice.probability > 0.0)) {
        return kNoLight;
    }
    noteLight(choice.light);
    group = hasFeature(kFeatureLightGroups) ? lightGroupOf(fetchLight(choice.light).kind) : 0u;
    return sampleChosenLight(id, choice, context, bounce);
}

// If --catcher-reflections are off, a path that met a catcher first brings nothing back from objects. `arrivedIn`: media of the ray that has
// met the surface.
void darkenObject(SurfaceInteraction si, uint bounce, uint arrivedIn, inout VertexResult result)
{
    bool isCatcher = result.firstHit.alpha < 0.0;
    bool remembers = bounce == 0u ? isCatcher && render.darkensObjects != 0u : (arrivedIn & kIsCatcherFirst) != 0u;
    bool isDark = remembers && !isCatcher && si.light == 0u;
    result.ray.media |= remembers ? kIsCatcherFirst : 0u;
    result.hasShadowRay = result.hasShadowRay && !isDark;
    result.hasNextRay = result.hasNextRay && !isDark;
}

VertexResult shadeSurface(SampleId id, PathRay ray, PathHit hit, PathState state)
{
    vec3 wo = -ray.direction;
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    uint arrivedIn = ray.media;
    if (hasFeature(kFeatureMedia)) {
        state.throughput *= pathTransmittance(ray.media, hit.t);
        setIndices(id, si, material, ray.media, state.throughput);
    }
    Bsdf bsdf = makeBsdf(si, material, wo);
    noteSurface(si, bsdf.frame.z);
    noteMaterial(si, hit, material, arrivedIn);
    VertexResult result;
    result.emitted = vec3(0.0);
    result.emittedGroup = lightGroupOf(material.data.flags);
    result.shadowGroup = 0u;
    if (hasEmissiveSurfaces()) {
        if (hasFeature(kFeatureClearcoat)) {
            material.data.emission *= passedCoat(material.layers.clearcoat, dot(si.ng, wo));
        }
        result.emitted = state.throughput * weightedEmission(si, material.data, ray, hit, state);
        if (isUnlit(material.data)) {
            result.emitted = state.throughput * material.data.baseColor;
        }
    }
    result.firstHit = makeFirstHit(si, material.data, wo);
    BounceNumbers u = sampleBounceNumbers(id, state.bounce);
    LightContext lightContext = makeLightContext(si, bsdf);
    Guide guide = kNoGuide;
    bool survives = true;
    if (kGuided) {
        if (hasNonDelta(bsdf)) {
            guide = fetchGuide(bsdf, lightContext);
        }
        result.learned = LearnedVertex(si.p, encodeNormal(bsdf.frame.z), vec3(0.0), state.throughput * guide.reflected, vec3(0.0), 0u, false);
        survives = survivesArrival(guide, u.roulette, state);
        result.learned.throughput = survives ? state.throughput : vec3(0.0);
    }
    bool samples = samplesLights(state.bounce, render.maxBounces, render.minPathLength, render.lightCount) && hasNonDelta(bsdf) && survives;
    LightSample light = kNoLight;
    LightChoice choice = LightChoice(0u, 0.0, 0u);
    if (samples) {
        light = sampleDirectLight(id, lightContext, state.bounce, choice, result.shadowGroup);
    }
    BsdfPair pair;
    float bsdfPdf;  // of the next direction
    if (kGuided) {  // also where no guide is known: a branch for these would cost as much as this one
        pair = evalAndSampleGuided(bsdf, guide, wo, light.wi, u.direction, u.lobe, bsdfPdf);
    } else {
        pair = evalAndSampleBsdf(bsdf, wo, light.wi, u.direction, u.lobe);
        bsdfPdf = pair.next.pdf;
    }
    result.hasShadowRay = samples && makeShadowRay(si, light, pair.light, state, result.shadowRay);
    if (hasFeature(kFeatureMedia) && result.hasShadowRay) {
        result.shadowRay.contribution *= mediaTransmittance(ray.media, si, bsdf.medium, result.shadowRay);
    }
    if (kLearns) {
        result.learned.sampled = result.hasShadowRay ? result.shadowRay.contribution : vec3(0.0);
        result.learned.lights = choice.part;
    }
    result.state = state;
    result.hasNextRay = survives && state.bounce < render.maxBounces && continuePath(pair.next, u, si, bsdf, ray.media, result.ray, result.state);
    result.learned.isNarrow = (pair.next.flags & kBsdfDelta) != 0u || bsdfPdf > kNarrowPdf;
    if (hasFeature(kFeatureCatcher)) {
        darkenObject(si, state.bounce, arrivedIn, result);
    }
    return result;
}

#endif
