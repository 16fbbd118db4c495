// One thread is one entry of the active queue. Samples the BSDF where its path has met a surface, plays the roulette that the render asks
// for, and queues the next ray. Comes after course_sample_lights of the same bounce.
// Reads the scene, the queue, hits. Updates rays and states; writes the note; appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define UPDATES_RAYS
#define READS_HITS
#define UPDATES_STATES
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#include "access/course/bounce.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"

void visit(uint slot)
{
    PathHit hit = fetchHit(slot);
    if (hit.primitiveRef == kNoPrimitiveRef) {
        return;
    }
    PathRay ray = fetchRay(slot);
    PathState state = fetchState(slot);
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    vec3 wo = -ray.direction;
    if (bouncePath(makeSampleId(slot), si, makeBsdf(si, material, wo), wo, 0u, ray, state)) {
        storeRay(slot, ray);
        storeState(slot, state);
        queuePath(slot, 1u);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (pass.bounce < render.maxBounces && entry < activePaths()) {
        visit(activeQueue[entry]);
    }
    checkLoopBudget(render.canarySteps);
}
