// The loop of the kernels that trace paths to their end. A thread takes entries of the queue, one after the other. Paths beyond its limits
// go into the next queue as they are.
// A kernel includes this behind its struct Path, which has at least slot, ray, state and light. It defines the functions that are declared
// here, the macros pathSides and connectionSides (of single-sided surfaces, for the path's rays and for those that connect it to a light or
// to the camera), and the constants kSeenByCamera (what these meet is seen by it), kDimmingFeatures (with which surfaces on the way dim the
// path) and kScatters (whether it scatters in media).
#ifndef GLIM_ACCESS_PATH_LOOP
#define GLIM_ACCESS_PATH_LOOP

#include "paths.glsl"
#include "scattering.glsl"
#include "status.glsl"
#include "traverse.glsl"

struct Work {
    uint closest, shadow;  // rays
    uint steps;
};

// What advance() traces: the path's ray, then a ray that connects it and meets alpha, and the light that this one carries.
struct TracedRay {
    AlphaRay alphaRay;
    vec3 contribution;
    uint receiver;    // as of addLight
    uint pathLength;  // surfaces met between camera and light
};

uint fetchEntry(uint entry);
bool takePath(uint entry, out Path path, inout Work work);  // false if it carries nothing
VisibleHit tracePathThroughAlpha(Path path, AlphaRay alphaRay, inout Steps steps);
// receiver: the pixel of a light path's light, the group of a camera path's.
void addLight(inout Path path, uint receiver, vec3 contribution, uint pathLength);
void visitMiss(inout Path path);
bool visitScattering(inout Path path, float t);  // false if the path ends
bool visitSurface(inout Path path, PathHit hit, inout Work work, inout Steps steps, inout TracedRay traced);  // false if the path ends
void endPath(Path path);

// Adds the light, unless surfaces with alpha dim it first: then the ray is `traced` next.
void traceConnection(inout Path path, ShadowRay ray, vec3 contribution, uint receiver, inout Work work, inout Steps steps,
                     inout TracedRay traced)
{
    bool metAlpha;
    bool clear = isUnoccluded(ray, connectionSides(path), steps, metAlpha);
    uint pathLength = path.state.bounce + 1u;
    ++work.shadow;
    if (hasFeature(kFeatureAlpha) && clear && metAlpha) {
        traced = TracedRay(makeAlphaRay(ray, connectionSides(path)), contribution, receiver, pathLength);
        traced.alphaRay.fromCamera = kSeenByCamera;
    } else if (clear) {
        addLight(path, receiver, contribution, pathLength);
    }
}

// Traces the path to its next surface or scattering. False if the path ends. The loop goes on for a ray that connects it and meets alpha.
bool advance(inout Path path, inout Work work)
{
    Steps steps = Steps(0u, 0u);
    TracedRay traced = TracedRay(makeAlphaRay(path.ray), vec3(0.0), 0u, 0u);
    traced.alphaRay.query.sides = pathSides(path);
    float freePath = kInfinity;
    if (hasFeature(kFeatureScattering) && kScatters) {
        freePath = sampleFreePath(path.id, path.ray, path.state);
        traced.alphaRay.query.tMax = reachOf(path.ray, freePath);
    }
    bool alive = false;
    bool again = false;
    do {
        VisibleHit met = tracePathThroughAlpha(path, traced.alphaRay, steps);
        again = false;
        if (hasFeature(kFeatureAlpha) && traced.alphaRay.isShadow) {
            if (isClear(met.weight)) {
                addLight(path, traced.receiver, traced.contribution * met.weight, traced.pathLength);
            }
        } else {
            ++work.closest;
            if (hasFeature(kFeatureScattering) && kScatters) {
                met.hit = meetFirst(path.ray, met.hit, freePath);
                path.state.throughput = throughputAt(path.ray, met.hit, path.state.throughput);
            }
            if (hasFeature(kDimmingFeatures)) {
                path.state.throughput *= met.weight;
            }
            if (met.hit.primitiveRef == kNoPrimitiveRef) {
                visitMiss(path);
            } else if (kScatters && isScattered(met.hit)) {
                alive = visitScattering(path, met.hit.t);
            } else {
                alive = visitSurface(path, met.hit, work, steps, traced);
                again = traced.alphaRay.isShadow;
            }
        }
    } while (hasFeature(kFeatureAlpha) && again);
    work.steps += steps.nodes + steps.primitives;
    return alive;
}

// Neighbouring threads that share a run of the queue, so that they stay in one place of the picture.
const uint kNeighbours = 8u;

void traceShare(uint entry, uint end, inout Work work)
{
    Path path;
    bool alive = false;
    if (entry < end) {
        do {
            if (!alive) {
                alive = takePath(fetchEntry(entry), path, work);
            }
            if (alive) {
                alive = advance(path, work);
            }
            if (!alive) {
                endPath(path);
                entry += kNeighbours;
            }
        } while (entry < end && work.steps < kStepsPerThread);
    }
    if (alive) {
        storeRay(path.slot, path.ray);
        storeState(path.slot, path.state);
        storeRadiance(path.slot, path.light);
        queuePath(path.slot, kPathsPerThread);
        entry += kNeighbours;
    }
    for (; entry < end; entry += kNeighbours) {
        queuePath(fetchEntry(entry), kPathsPerThread);
    }
}

void traceQueue()
{
    uint thread = interleavedInvocation();
    if (thread == 0u) {
        checkPaths();
    }
    uint lane = thread % kNeighbours;
    uint begin = (thread - lane) * kPathsPerThread;
    Work work = Work(0u, 0u, 0u);
    traceShare(begin + lane, min(activePaths(), begin + kNeighbours * kPathsPerThread), work);
    countRays(work.closest, work.shadow);
    checkLoopBudget(render.canarySteps);
}

#endif
