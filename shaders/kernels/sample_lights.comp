// One thread is one entry of the active queue. Asks for a shadow ray to one light that the surface may see: a round of direct
// light. The first round also adds the light that the ray itself has found and, at bounce 0, notes what the camera saw.
// Reads the scene, the queue, rays, hits, states. Updates radiance. Writes first hits, shadow rays, the note; appends
// to the shadow queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define READS_RAYS
#define READS_HITS
#define READS_STATES
#define UPDATES_RADIANCE
#define WRITES_FIRST_HITS
#define WRITES_SHADOW_RAYS
#define WRITES_SHADOW_QUEUE
#define UPDATES_QUEUE_TAILS
#include "access/light.glsl"
#include "access/notes.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"
#include "lib/mis.glsl"
#include "lib/scatter.glsl"

// What light that a ray has found counts if sampling lights has density `other` for it, and what light counts that sampling
// lights has found if the scattered ray has that density. Cameras, mirrors and glass leave it to the ray alone, delta lights
// to the sample.
float weightFound(PathState state, float other)
{
    if (!(state.pdf > 0.0) || kDirect == kDirectBsdf) {
        return 1.0;
    }
    float weight = kDirect == kDirectMis ? weightPower(state.pdf, other) : 0.0;
    noteFound(other, weight);
    return weight;
}

float weightSampled(float pdf, float other)
{
    return kDirect == kDirectMis && pdf > 0.0 ? weightPower(pdf, other) : 1.0;
}

vec3 environmentFound(PathState state)
{
    float other = fetchLight(pass.environmentLight).probability * pdfLambert(state.cosine);
    return pass.environment * weightFound(state, other);
}

vec3 emissionFound(PathRay ray, PathHit hit, PathState state, Surface surface, FlatMaterial material)
{
    vec3 emission = emittedRadiance(surface, material);
    if (all(equal(emission, vec3(0.0))) || !(state.pdf > 0.0)) {
        return emission;
    }
    FlatEmitter emitter = fetchEmitter(surface.emitter - 1u);
    float cosine = abs(dot(surface.geometric, ray.direction));
    float other = pdfSurfaceLight(emitter, fetchLight(emitter.light), ray.origin, hit.t, cosine);
    return emission * weightFound(state, other);
}

// The radiance of one light that the round chooses, seen `from` the point that rays leave the surface from.
LightSample sampleLightOfRound(SampleId id, vec3 from, vec3 normal)
{
    uint chosen = pass.light;
    if (kDirect == kDirectMis) {
        chosen = chooseLight(samplePair(id, bounceDimension(pass.bounce, kDimensionLight), kSobol), pass.lightCount);
    } else {
        id = splitSample(id, pass.light, pass.lightSample, pass.lightSamples);
    }
    noteLight(chosen);
    return sampleLight(chosen, kDirect != kDirectMis, from, normal,
                       samplePair(id, bounceDimension(pass.bounce, kDimensionEmitter), kSobol),
                       unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionPoint), kSobol)));
}

// Carries the radiance that the light sends on towards the camera if nothing shadows it.
void askForShadowRay(uint slot, PathState state, Surface surface, FlatMaterial material)
{
    vec3 origin = leavePoint(surface, surface.geometric);
    LightSample light = sampleLightOfRound(sampleOfSlot(slot), origin, surface.shading);
    float cosine = dot(light.wi, surface.shading);
    if (!(cosine > 0.0 && dot(light.wi, surface.geometric) > 0.0)) {
        return;
    }
    float weight = weightSampled(light.pdf, pdfLambert(cosine));
    if (kDirect == kDirectLights) {
        weight /= float(pass.lightSamples);
    }
    noteLightSample(light.pdf, pdfLambert(cosine), weight);
    vec3 contribution = state.throughput * evalLambert(material.baseColor, cosine) * light.radiance * (cosine * weight);
    if (all(equal(contribution, vec3(0.0)))) {
        return;
    }
    bool infinite = light.reach > 1.0;
    pathShadowRays[slot] = ShadowRay(origin, fetchHit(slot).record, infinite ? light.wi : light.target - origin,
                                     light.record, contribution, light.reach);
    shadowQueue[atomicAdd(queueTails.shadow, 1u)] = slot;
}

void noteFirstHit(uint slot, Surface surface, FlatMaterial material)
{
    float depth = dot(surface.point - sceneCamera.position, sceneCamera.forward);
    pathFirstHits[slot] = FirstHit(material.baseColor, 1.0, surface.shading, depth);
}

void visitNothing(uint slot, PathState state)
{
    if (pass.bounce == 0u) {
        pathFirstHits[slot] = FirstHit(vec3(0.0), 0.0, vec3(0.0), kInfinity);
    }
    if (kEnvironment) {
        addRadiance(slot, state.throughput * environmentFound(state), pass.bounce, 1u);
    }
}

void visit(uint slot)
{
    PathRay ray = fetchRay(slot);
    PathHit hit = fetchHit(slot);
    PathState state = fetchState(slot);
    bool first = pass.addsFound != 0u;
    if (hit.record == kNoRecord) {
        if (first) {
            visitNothing(slot, state);
        }
        return;
    }
    Surface surface = surfaceAt(ray, hit);
    turnToViewer(surface, -ray.direction);
    noteSurface(surface);
    FlatMaterial material = fetchMaterial(surface.material);
    if (first && pass.bounce == 0u) {
        noteFirstHit(slot, surface, material);
    }
    if (first && kSurfaceLights) {
        addRadiance(slot, state.throughput * emissionFound(ray, hit, state, surface, material), pass.bounce, 1u);
    }
    if (pass.light != kNoLightIndex && material.scattering == kLambert) {
        askForShadowRay(slot, state, surface, material);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < queueSizes.closest) {
        visit(activeQueue[entry]);
    }
    checkLoopBudget(pass.canarySteps);
}
