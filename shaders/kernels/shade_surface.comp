// One thread is one entry of the active queue. Shades what its ray has met: adds the light that the ray itself has hit, samples one light
// and queues a shadow ray to it, and samples the BSDF with roulette and queues the next ray. One dispatch does both, so that interaction,
// material and BSDF are made once.
// A path that has scattered last goes on.
// Reads the scene, the queue, hits. Updates rays, states, radiance, light of groups. Writes first hits, shadow rays, the note; appends to the shadow
// queue and the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define UPDATES_RAYS
#define READS_HITS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define UPDATES_GROUP_LIGHT
#define WRITES_FIRST_HITS
#define WRITES_SHADOW_RAYS
#define WRITES_SHADOW_QUEUE
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#include "access/catcher.glsl"
#include "access/path_time.glsl"
#include "access/path_vertex.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"

void addLight(uint slot, uint group, vec3 contribution, uint pathLength)
{
    addRadiance(slot, contribution, pathLength);
    if (hasFeature(kFeatureLightGroups)) {
        addToGroup(slot, group, contribution, pathLength);
    }
}

void visitMiss(uint slot, PathRay ray, PathState state)
{
    if (bounceOf(state) == 0u) {
        storeFirstHit(slot, makeNoFirstHit());
    }
    if (hasEnvironment()) {
        addLight(slot, environmentGroup(), shadeMiss(ray, state), bounceOf(state));
    }
}

// Of a path that has scattered, and walks on in the next round unless it has ended.
void visitScattering(uint slot, PathState state)
{
    if (state.throughput != vec3(0.0)) {
        queuePath(slot, 1u);
    }
}

void visitSurface(uint slot, PathRay ray, PathHit hit, PathState state)
{
    SampleId id = makeSampleId(slot);
    beginPath(id);
    VertexResult vertex = shadeSurface(id, ray, hit, state);
    if (bounceOf(state) == 0u) {
        storeFirstHit(slot, vertex.firstHit);
    }
    if (hasFeature(kFeatureCatcher) && endsAtObject(slot, bounceOf(state), vertex.firstHit)) {
        return;
    }
    if (hasEmissiveSurfaces()) {
        addLight(slot, vertex.emittedGroup, vertex.emitted, bounceOf(state));
    }
    if (vertex.hasShadowRay) {
        storeShadowRay(slot, vertex.shadowRay);
        if (hasFeature(kFeatureLightGroups)) {
            storeShadowGroup(slot, vertex.shadowGroup);
        }
        queueShadowRay(slot);
    }
    if (vertex.hasNextRay || (hasFeature(kFeatureScattering) && vertex.hasShadowRay)) {
        storeState(slot, vertex.state);  // trace_shadow reads the bounce
    }
    if (vertex.hasNextRay) {
        storeRay(slot, vertex.ray);
        queuePath(slot, 1u);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < activePaths()) {
        uint slot = activeQueue[entry];
        PathRay ray = fetchRay(slot);
        PathHit hit = fetchHit(slot);
        PathState state = fetchState(slot);
        if (hit.primitiveRef == kNoPrimitiveRef) {
            visitMiss(slot, ray, state);
        } else if (isScattered(hit)) {
            visitScattering(slot, state);
        } else {
            visitSurface(slot, ray, hit, state);
        }
    }
    checkLoopBudget(render.canarySteps);
}
