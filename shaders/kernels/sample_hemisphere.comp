// One thread is one entry of the active queue. Asks for a ray in a direction that is uniform over the hemisphere, which may find a
// light. A round of --direct hemisphere; comes between sample_lights and bounce.
// Reads the scene, the queue, rays, hits, states. Writes shadow rays; appends to the shadow queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define READS_RAYS
#define READS_HITS
#define READS_STATES
#define WRITES_SHADOW_RAYS
#define WRITES_SHADOW_QUEUE
#define UPDATES_QUEUE_TAILS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/surface.glsl"
#include "lib/infinity.glsl"
#include "lib/scatter.glsl"

void askForRay(uint slot, Surface surface, FlatMaterial material)
{
    SampleId id = splitSample(sampleOfSlot(slot), kNoLightIndex, pass.lightSample, pass.lightSamples);
    vec2 u = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionPoint), kSobol));
    vec3 local = sampleUniformHemisphere(u);
    vec3 wi = worldFromFrame(makeFrame(surface.shading), local);
    if (!(dot(wi, surface.geometric) > 0.0)) {
        return;
    }
    float share = local.z / (pdfUniformHemisphere() * float(pass.lightSamples));
    vec3 contribution = fetchState(slot).throughput * evalLambert(material.baseColor, local.z) * share;
    if (all(equal(contribution, vec3(0.0)))) {
        return;
    }
    pathShadowRays[slot] =
        ShadowRay(leavePoint(surface, wi), surface.primitive, wi, kNoRecord, contribution, kInfinity);
    shadowQueue[atomicAdd(queueTails.shadow, 1u)] = slot;
}

void visit(uint slot)
{
    PathHit hit = fetchHit(slot);
    if (hit.record == kNoRecord) {
        return;
    }
    PathRay ray = fetchRay(slot);
    Surface surface = surfaceAt(ray, hit);
    turnToViewer(surface, -ray.direction);
    FlatMaterial material = fetchMaterial(surface.material);
    if (material.scattering == kLambert) {
        askForRay(slot, surface, material);
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
