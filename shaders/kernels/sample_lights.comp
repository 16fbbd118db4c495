// One thread is one entry of the active queue. Adds the light that its ray has found, and asks for a shadow ray to one light
// that the surface may see. At bounce 0 it also notes what the camera saw.
// Reads the scene, the queue, rays, hits, states. Updates radiance. Writes first hits, shadow rays; appends to the shadow queue.
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
#include "access/radiance.glsl"
#include "access/status.glsl"
#include "access/surface.glsl"
#include "lib/mis.glsl"
#include "lib/scatter.glsl"

vec3 environmentFound(PathState state)
{
    float other = fetchLight(pass.environmentLight).probability * pdfLambert(state.cosine);
    return pass.environment * (state.pdf > 0.0 ? weightPower(state.pdf, other) : 1.0);
}

vec3 emissionFound(PathRay ray, PathHit hit, PathState state, Surface surface, FlatMaterial material)
{
    if (surface.emitter == 0u || !(surface.front || material.doubleSided != 0u)) {
        return vec3(0.0);
    }
    if (!(state.pdf > 0.0)) {
        return material.emission;
    }
    FlatEmitter emitter = fetchEmitter(surface.emitter - 1u);
    float cosine = abs(dot(surface.geometric, ray.direction));
    float other = pdfSurfaceLight(emitter, fetchLight(emitter.light), ray.origin, hit.t, cosine);
    return material.emission * weightPower(state.pdf, other);
}

// The radiance that one light sends on towards the camera if nothing shadows it; 0 if there is none.
void askForShadowRay(uint slot, PathState state, Surface surface, FlatMaterial material)
{
    SampleId id = sampleOfSlot(slot);
    uint chosen = chooseLight(samplePair(id, bounceDimension(pass.bounce, kDimensionLight), kSobol), pass.lightCount);
    LightSample light =
        sampleLight(chosen, surface.point, surface.shading,
                    samplePair(id, bounceDimension(pass.bounce, kDimensionEmitter), kSobol),
                    unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionPoint), kSobol)));
    float cosine = dot(light.wi, surface.shading);
    if (!(cosine > 0.0 && dot(light.wi, surface.geometric) > 0.0)) {
        return;
    }
    float weight = light.pdf > 0.0 ? weightPower(light.pdf, pdfLambert(cosine)) : 1.0;
    vec3 contribution = state.throughput * evalLambert(material.baseColor, cosine) * light.radiance * (cosine * weight);
    if (all(equal(contribution, vec3(0.0)))) {
        return;
    }
    vec3 origin = leavePoint(surface, light.wi);
    bool infinite = light.reach > 1.0;
    pathShadowRays[slot] = ShadowRay(origin, pathHits[slot].record, infinite ? light.wi : light.target - origin,
                                     light.record, contribution, light.reach);
    shadowQueue[atomicAdd(queueTails.shadow, 1u)] = slot;
}

void visit(uint slot)
{
    PathRay ray = pathRays[slot];
    PathHit hit = pathHits[slot];
    PathState state = pathStates[slot];
    if (hit.record == kNoRecord) {
        if (pass.bounce == 0u) {
            pathFirstHits[slot] = FirstHit(vec3(0.0), 0.0, vec3(0.0), kInfinity);
        }
        if (kEnvironment) {
            addRadiance(slot, state.throughput * environmentFound(state), pass.bounce);
        }
        return;
    }
    Surface surface = surfaceAt(ray, hit);
    turnToViewer(surface, -ray.direction);
    FlatMaterial material = fetchMaterial(surface.material);
    if (pass.bounce == 0u) {
        float depth = dot(surface.point - sceneCamera.position, sceneCamera.forward);
        pathFirstHits[slot] = FirstHit(material.baseColor, 1.0, surface.shading, depth);
    }
    if (kSurfaceLights) {
        addRadiance(slot, state.throughput * emissionFound(ray, hit, state, surface, material), pass.bounce);
    }
    if (pass.lightCount > 0u && pass.bounce < pass.maxBounces && material.scattering == kLambert) {
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
