// One thread takes paths of the active queue, one after the other, and traces each to its end: the other schedule, instead of
// trace_closest, sample_lights, trace_shadow and bounce. Light is added in the order in which those do. Paths that it has no time
// for go into the next queue as they are.
// Reads the scene, the queue. Updates rays, states, radiance, ray counts. Writes first hits; appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define UPDATES_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define WRITES_FIRST_HITS
#define WRITES_NEXT_QUEUE
#define UPDATES_QUEUE_TAILS
#define UPDATES_RAY_COUNTS
#include "access/direct_light.glsl"
#include "access/first_hit.glsl"
#include "access/radiance.glsl"
#include "access/scatter_path.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

// Threads side by side that share a run of the queue, so that they stay in one place of the picture.
const uint kNeighbours = 8u;

struct Path {
    uint slot;
    SampleId id;
    PathRay ray;
    PathState state;
    PathRadiance light;
};

struct Work {
    uint closest, shadow;  // rays
    uint steps;
};

Path takePath(uint slot)
{
    return Path(slot, sampleOfSlot(slot), fetchRay(slot), fetchState(slot), fetchRadiance(slot));
}

void addLight(inout Path path, vec3 contribution, uint events, uint samples)
{
    if (isWanted(events)) {
        path.light = addLight(path.light, contribution, events, samples);
    }
}

void leaveScene(inout Path path)
{
    if (path.state.bounce == 0u) {
        pathFirstHits[path.slot] = makeNoFirstHit();
    }
    if (kEnvironment) {
        addLight(path, path.state.throughput * environmentFound(path.state), path.state.bounce, 1u);
    }
}

void addSampledLight(inout Path path, Surface surface, FlatMaterial material, inout Work work)
{
    ShadowRay ray;
    if (!sampleDirectLight(path.id, path.state.bounce, path.state, surface, material, ray)) {
        return;
    }
    Steps steps;
    bool clear = isUnoccluded(ray, steps);
    ++work.shadow;
    work.steps += steps.nodes + steps.primitives;
    if (clear) {
        addLight(path, ray.contribution, path.state.bounce + 1u, pass.lightSamples);
    }
}

// Light sampled here has met one surface more than the path; the last hit only finds light.
bool samplesLights(uint bounce)
{
    return pass.light != kNoLightIndex && bounce < pass.maxBounces && bounce + 1u >= pass.leastEvents;
}

void shade(inout Path path, PathHit hit, Surface surface, inout Work work)
{
    turnToViewer(surface, -path.ray.direction);
    FlatMaterial material = fetchMaterial(surface.material);
    if (path.state.bounce == 0u) {
        pathFirstHits[path.slot] = firstHitOf(surface, material);
    }
    if (kTriangleLights || kSphereLights) {
        vec3 found = emissionFound(path.ray, hit, path.state, surface, material);
        addLight(path, path.state.throughput * found, path.state.bounce, 1u);
    }
    if (samplesLights(path.state.bounce) && material.scattering == kLambert) {
        addSampledLight(path, surface, material, work);
    }
}

// To the next surface. False if that ends the path.
bool advance(inout Path path, inout Work work)
{
    Steps steps;
    PathHit hit = traceClosest(path.ray, steps);
    ++work.closest;
    work.steps += steps.nodes + steps.primitives;
    if (hit.record == kNoRecord) {
        leaveScene(path);
        return false;
    }
    Surface surface = surfaceAt(path.ray, hit);
    shade(path, hit, surface, work);
    return path.state.bounce < pass.maxBounces &&
           scatterPath(path.id, path.state.bounce, surface, path.ray, path.state);
}

void traceShare(uint entry, uint end, inout Work work)
{
    Path path;
    bool alive = false;
    if (entry < end) {
        do {
            if (!alive) {
                path = takePath(activeQueue[entry]);
            }
            alive = advance(path, work);
            if (!alive) {
                pathRadiance[path.slot] = path.light;
                entry += kNeighbours;
            }
        } while (entry < end && work.steps < kStepsPerThread);
    }
    if (alive) {
        pathRays[path.slot] = path.ray;
        pathStates[path.slot] = path.state;
        pathRadiance[path.slot] = path.light;
    }
    for (; entry < end; entry += kNeighbours) {
        nextQueue[atomicAdd(queueTails.next, 1u)] = activeQueue[entry];
    }
}

void main()
{
    uint thread = interleavedInvocation();
    uint lane = thread % kNeighbours;
    uint begin = (thread - lane) * kPathsPerThread;
    Work work = Work(0u, 0u, 0u);
    traceShare(begin + lane, min(queueSizes.closest, begin + kNeighbours * kPathsPerThread), work);
    countRays(work.closest, work.shadow);
    checkLoopBudget(pass.canarySteps);
}
