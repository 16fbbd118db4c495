// One thread takes light paths of the pass, one after the other, and traces each to its end. A path begins at a lamp, meets a specular surface
// first, and is then seen by the camera from every surface that is not: caustics, which paths from the camera leave out. Slot i of the pass is
// light path firstPixel + i, counted from that of sample firstSample on. Paths beyond the kernel's limits go into the next queue as they are.
// Reads the scene; the queue unless it is the pass's first dispatch. Updates rays, states, radiance (the paths' flux), splats, ray counts.
// Appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define UPDATES_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define WRITES_NEXT_QUEUE
#define UPDATES_QUEUE_TAILS
#define UPDATES_RAY_COUNTS
#include "access/light_path.glsl"
#include "access/light_traversal.glsl"
#include "access/light_vertex.glsl"
#include "access/paths.glsl"
#include "access/splats.glsl"
#include "access/start_media.glsl"
#include "access/traverse.glsl"

struct LightPath {
    uint slot;
    SampleId id;
    PathRay ray;
    PathState state;
    vec3 flux;
    float range;
};

struct Work {
    uint closest, shadow;  // rays
    uint steps;
};

SampleId lightPathOfSlot(uint slot)
{
    uint number = pass.firstPixel + slot, sample_ = number / render.lightPaths;
    return lightPathId(render.seed, number - sample_ * render.lightPaths, pass.firstSample + sample_);
}

// In the queue, beside the slot: the path has not begun.
const uint kUnbegun = 0x80000000u;

uint fetchEntry(uint entry)
{
    return pass.bounce == 0u ? entry | kUnbegun : activeQueue[entry];
}

LightPath takePath(uint entry, inout Work work)
{
    uint slot = entry & ~kUnbegun;
    SampleId id = lightPathOfSlot(slot);
    if ((entry & kUnbegun) == 0u) {
        return LightPath(slot, id, fetchRay(slot), fetchState(slot), fetchRadiance(slot).radiance, 0.0);
    }
    LightRay light = sampleEmission(id);
    if (hasFeature(kFeatureLampsInMedia) && any(notEqual(light.flux, vec3(0.0)))) {
        Steps steps = Steps(0u, 0u);
        light.ray.media = mediaAround(light.ray.origin, steps);
        work.steps += steps.nodes + steps.primitives;
    }
    return LightPath(slot, id, light.ray, PathState(vec3(1.0), 0.0, 0.0, 1.0, 0u, 0u), light.flux, light.range);
}

// What advance() follows: the path's ray, then a ray to the camera that meets alpha and the light that it carries.
struct Followed {
    Passage passage;
    vec3 contribution;
    uint pixel;
    uint pathLength;
};

// Adds the light, unless surfaces with alpha dim it first: then the ray is `followed` next.
void traceCameraRay(LightPath path, LightVertex vertex, uint pathLength, inout Work work, inout Steps steps, inout Followed followed)
{
    ShadowRay ray = vertex.cameraRay;
    bool metAlpha;
    bool clear = isUnoccluded(ray, kBacks, steps, metAlpha);
    vec3 contribution = path.flux * ray.contribution;
    ++work.shadow;
    if (hasFeature(kFeatureAlpha) && clear && metAlpha) {
        followed = Followed(passageOf(ray, kBacks), contribution, vertex.pixel, pathLength);
        followed.passage.fromCamera = true;
    } else if (clear) {
        addSplat(vertex.pixel, path.id.index, contribution, pathLength);
    }
}

// False if the path ends.
bool visitSurface(inout LightPath path, PathHit hit, inout Work work, inout Steps steps, inout Followed followed)
{
    if (path.state.bounce == 0u) {
        path.flux *= rangeFalloff(hit.t * hit.t, path.range);
    }
    LightVertex vertex = shadeLightVertex(path.id, path.ray, hit, path.state);
    if (vertex.hasSplat) {
        traceCameraRay(path, vertex, path.state.bounce + 1u, work, steps, followed);
    }
    path.ray = vertex.ray;
    path.state = vertex.state;
    return vertex.hasNextRay;
}

// Traces the path to its next surface. False if the path ends. The loop goes on for a ray to the camera that meets alpha.
bool advance(inout LightPath path, inout Work work)
{
    Steps steps = Steps(0u, 0u);
    Followed followed = Followed(lightPassageOf(path.ray), vec3(0.0), 0u, 0u);
    bool alive = false;
    bool again = false;
    do {
        VisibleHit met = followLight(path.id, path.state.bounce + 1u, followed.passage, steps);  // no ray of it is the camera's
        again = false;
        if (hasFeature(kFeatureAlpha) && followed.passage.isShadow) {
            if (isClear(met.weight)) {
                addSplat(followed.pixel, path.id.index, followed.contribution * met.weight, followed.pathLength);
            }
        } else {
            ++work.closest;
            if (hasFeature(kFeatureThinWalls | kFeatureSingleSided)) {
                path.state.throughput *= met.weight;
            }
            if (met.hit.record != kNoRecord) {
                alive = visitSurface(path, met.hit, work, steps, followed);
                again = followed.passage.isShadow;
            }
        }
    } while (hasFeature(kFeatureAlpha) && again);
    work.steps += steps.nodes + steps.primitives;
    return alive;
}

// Neighbouring threads that share a run of slots.
const uint kNeighbours = 8u;

void traceShare(uint entry, uint end, inout Work work)
{
    LightPath path;
    bool alive = false;
    if (entry < end) {
        do {
            if (!alive) {
                path = takePath(fetchEntry(entry), work);
                alive = any(notEqual(path.flux, vec3(0.0)));
            }
            if (alive) {
                alive = advance(path, work);
            }
            entry += alive ? 0u : kNeighbours;
        } while (entry < end && work.steps < kStepsPerThread);
    }
    if (alive) {
        pathRays[path.slot] = path.ray;
        pathStates[path.slot] = path.state;
        pathRadiance[path.slot] = PathRadiance(path.flux, 0.0);
        nextQueue[atomicAdd(queueTails.next, 1u)] = path.slot;
        entry += kNeighbours;
    }
    for (; entry < end; entry += kNeighbours) {
        nextQueue[atomicAdd(queueTails.next, 1u)] = fetchEntry(entry);
    }
}

void main()
{
    uint thread = interleavedInvocation();
    uint lane = thread % kNeighbours;
    uint begin = (thread - lane) * kPathsPerThread;
    uint count = pass.bounce == 0u ? pass.pixelCount : queueSizes.closest;
    Work work = Work(0u, 0u, 0u);
    traceShare(begin + lane, min(count, begin + kNeighbours * kPathsPerThread), work);
    countRays(work.closest, work.shadow);
    checkLoopBudget(render.canarySteps);
}
