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
#include "access/direct_light.glsl"
#include "access/first_hit.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"

void askForShadowRay(uint slot, PathState state, Surface surface, FlatMaterial material)
{
    ShadowRay ray;
    if (sampleDirectLight(sampleOfSlot(slot), pass.bounce, state, surface, material, ray)) {
        pathShadowRays[slot] = ray;
        shadowQueue[atomicAdd(queueTails.shadow, 1u)] = slot;
    }
}

void visitNothing(uint slot, PathState state)
{
    if (pass.bounce == 0u) {
        pathFirstHits[slot] = makeNoFirstHit();
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
        pathFirstHits[slot] = firstHitOf(surface, material);
    }
    if (first && (kTriangleLights || kSphereLights)) {
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
