// One thread is one entry of the active queue. Queues a shadow ray to one light that the surface may see: a round of direct
// light. The first round also adds the light that the ray itself has hit and, at bounce 0, writes the first hit.
// Reads the scene, the queue, rays, hits, states. Updates radiance. Writes first hits, shadow rays, the note; appends
// to the shadow queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_RAYS
#define READS_HITS
#define READS_STATES
#define UPDATES_RADIANCE
#define WRITES_FIRST_HITS
#define WRITES_SHADOW_RAYS
#define WRITES_SHADOW_QUEUE
#define UPDATES_ROUNDS
#include "access/course/round.glsl"
#include "access/course/direct_light.glsl"
#include "access/first_hit.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"

void visitMiss(uint slot, PathRay ray, PathState state)
{
    if (pass.bounce == 0u) {
        storeFirstHit(slot, makeNoFirstHit());
    }
    if (hasEnvironment()) {
        addRadiance(slot, state.throughput * weightedEnvironment(ray, state), pass.bounce);
    }
}

void visitSurface(uint slot, PathRay ray, PathHit hit, PathState state)
{
    vec3 wo = -ray.direction;
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    Bsdf bsdf = makeBsdf(si, material, wo);
    noteSurface(si, bsdf.frame.z);
    noteMaterial(si, hit, material, 0u);
    bool first = lightRound.addsEmission != 0u;
    if (first && pass.bounce == 0u) {
        storeFirstHit(slot, makeFirstHit(si, material.data, wo));
    }
    if (first && hasEmissiveSurfaces()) {
        addRadiance(slot, state.throughput * weightedEmission(si, material.data, ray, hit, state), pass.bounce);
    }
    ShadowRay shadow;
    if (lightRound.light != kNoLightIndex && hasNonDelta(bsdf) &&
        sampleLightOfRound(makeSampleId(slot), si, bsdf, wo, state, shadow)) {
        storeShadowRay(slot, shadow);
        queueShadowRay(slot);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < activePaths()) {
        uint slot = activeQueue[entry];
        PathHit hit = fetchHit(slot);
        if (hit.primitiveRef != kNoPrimitiveRef) {
            visitSurface(slot, fetchRay(slot), hit, fetchState(slot));
        } else if (lightRound.addsEmission != 0u) {
            visitMiss(slot, fetchRay(slot), fetchState(slot));
        }
    }
    checkLoopBudget(render.canarySteps);
}
