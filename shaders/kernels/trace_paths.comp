// One thread takes paths of the active queue, one after the other, and traces each to its end: the other schedule, instead of
// trace_closest, sample_lights_and_bounce and trace_shadow. Paths beyond its limits go into the next queue as they are.
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
#include "access/path_vertex.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

// Neighbouring threads that share a run of the queue, so that they stay in one place of the picture.
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

void addLight(inout Path path, vec3 contribution, uint pathLength)
{
    if (isLengthInRange(pathLength)) {
        path.light = addLight(path.light, contribution, pathLength, render.clampIndirect);
    }
}

void visitMiss(inout Path path)
{
    if (path.state.bounce == 0u) {
        pathFirstHits[path.slot] = makeNoFirstHit();
    }
    if (hasEnvironment()) {
        addLight(path, shadeMiss(path.ray, path.state), path.state.bounce);
    }
}

// What advance() follows: the path's ray, then a shadow ray that meets alpha and the light that it carries.
struct Followed {
    Passage passage;
    vec3 contribution;
    uint pathLength;
};

// Adds the light, unless surfaces with alpha dim it first: then the ray is `followed` next.
void traceShadowRay(inout Path path, ShadowRay ray, inout Work work, inout Steps steps, inout Followed followed)
{
    bool metAlpha;
    bool clear = isUnoccluded(ray, kFronts, steps, metAlpha);
    ++work.shadow;
    if (hasFeature(kFeatureAlpha) && clear && metAlpha) {
        followed = Followed(passageOf(ray, kFronts), ray.contribution, path.state.bounce + 1u);
    } else if (clear) {
        addLight(path, ray.contribution, path.state.bounce + 1u);
    }
}

// Adds light in the order in which the wavefront does. False if the path ends.
bool visitSurface(inout Path path, PathHit hit, inout Work work, inout Steps steps, inout Followed followed)
{
    VertexResult vertex = shadeSurface(path.id, path.ray, hit, path.state);
    if (path.state.bounce == 0u) {
        pathFirstHits[path.slot] = vertex.firstHit;
    }
    if (hasEmissiveSurfaces()) {
        addLight(path, vertex.emitted, path.state.bounce);
    }
    if (vertex.hasShadowRay) {
        traceShadowRay(path, vertex.shadowRay, work, steps, followed);
    }
    path.ray = vertex.ray;
    path.state = vertex.state;
    return vertex.hasNextRay;
}

// Traces the path to its next surface. False if the path ends. The loop goes on for a shadow ray that meets alpha.
bool advance(inout Path path, inout Work work)
{
    Steps steps = Steps(0u, 0u);
    Followed followed = Followed(passageOf(path.ray), vec3(0.0), 0u);
    bool alive = false;
    bool again = false;
    do {
        VisibleHit met = follow(path.id, path.state.bounce, followed.passage, steps);
        again = false;
        if (hasFeature(kFeatureAlpha) && followed.passage.isShadow) {
            if (isClear(met.weight)) {
                addLight(path, followed.contribution * met.weight, followed.pathLength);
            }
        } else {
            ++work.closest;
            if (hasFeature(kFeatureThinWalls)) {
                path.state.throughput *= met.weight;
            }
            if (met.hit.record == kNoRecord) {
                visitMiss(path);
            } else {
                alive = visitSurface(path, met.hit, work, steps, followed);
                again = followed.passage.isShadow;
            }
        }
    } while (hasFeature(kFeatureAlpha) && again);
    work.steps += steps.nodes + steps.primitives;
    return alive;
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
    checkLoopBudget(render.canarySteps);
}
