// One thread is one entry of the active queue. Queues a ray in a direction that is uniform over the hemisphere, which may hit a
// light. A round of --direct hemisphere; comes between course_sample_lights and course_bounce.
// Reads the scene, the queue, rays, hits, states. Writes shadow rays; appends to the shadow queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_RAYS
#define READS_HITS
#define READS_STATES
#define WRITES_SHADOW_RAYS
#define WRITES_SHADOW_QUEUE
#define UPDATES_ROUNDS
#include "access/course/round.glsl"
#include "access/bsdf.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/course/split_sample.glsl"
#include "lib/course/uniform_hemisphere.glsl"
#include "lib/finite.glsl"

void queueRay(uint slot, SurfaceInteraction si, Bsdf bsdf, vec3 wo)
{
    SampleId id = splitSample(makeSampleId(slot), kNoLightIndex, lightRound.lightSample, lightRound.lightSamples);
    vec2 u = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionPoint), kSobol));
    vec3 local = sampleUniformHemisphere(u);
    vec3 wi = worldFromFrame(bsdf.frame, local);
    BsdfEval f = evalBsdf(bsdf, wo, wi);
    vec3 contribution = fetchState(slot).throughput * f.f / (pdfUniformHemisphere() * float(lightRound.lightSamples));
    if (all(equal(contribution, vec3(0.0)))) {
        return;
    }
    storeShadowRay(slot, ShadowRay(offsetRayOrigin(si, wi), si.primitive, wi, kNoPrimitiveRef, contribution, kInfinity));
    queueShadowRay(slot);
}

void visit(uint slot)
{
    PathHit hit = fetchHit(slot);
    if (hit.primitiveRef == kNoPrimitiveRef) {
        return;
    }
    PathRay ray = fetchRay(slot);
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    Bsdf bsdf = makeBsdf(si, material, -ray.direction);
    if (hasNonDelta(bsdf)) {
        queueRay(slot, si, bsdf, -ray.direction);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < activePaths()) {
        visit(activeQueue[entry]);
    }
    checkLoopBudget(render.canarySteps);
}
