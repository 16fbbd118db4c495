// A path's vertex: what happens where a ray meets a surface, or nothing. Both schedules call shadeSurface and shadeMiss; they only
// store, trace and queue. Conditions select values rather than branch: on CPUs each value that differs between two branches costs
// two masked stores (tests/bench/EXPERIMENTS.md).
#ifndef GLIM_ACCESS_PATH_VERTEX
#define GLIM_ACCESS_PATH_VERTEX

#include "direct_light.glsl"
#include "first_hit.glsl"
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

float computeContinuation(BsdfSample s, vec3 throughput, float etaScale, uint bounce)
{
    return continuationProbability(throughput, etaScale, bounce);
}

LightSample sampleDirectLight(SampleId id, SurfaceInteraction si, Bsdf bsdf, uint bounce, out uint group)
{
    LightContext context = makeLightContext(si, bsdf);
    LightChoice choice = chooseLight(id, context, bounce);
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
    bool samples = samplesLights(state.bounce, render.maxBounces, render.minPathLength, render.lightCount) && hasNonDelta(bsdf);
    LightSample light = kNoLight;
    if (samples) {
        light = sampleDirectLight(id, si, bsdf, state.bounce, result.shadowGroup);
    }
    BounceNumbers u = sampleBounceNumbers(id, state.bounce);
    BsdfPair pair = evalAndSampleBsdf(bsdf, wo, light.wi, u.direction, u.lobe);
    result.hasShadowRay = samples && makeShadowRay(si, light, pair.light, state, result.shadowRay);
    if (hasFeature(kFeatureMedia) && result.hasShadowRay) {
        result.shadowRay.contribution *= mediaTransmittance(ray.media, si, bsdf.medium, result.shadowRay);
    }
    result.state = state;
    result.hasNextRay = state.bounce < render.maxBounces && continuePath(pair.next, u, si, bsdf, ray.media, result.ray, result.state);
    if (hasFeature(kFeatureCatcher)) {
        darkenObject(si, state.bounce, arrivedIn, result);
    }
    return result;
}

#endif
