// One thread is one entry of the active queue. Finds what its ray meets first. In media that scatter the path walks there.
// Reads the scene, the queue. Writes hits. Updates rays, states, ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_ROUNDS
#define UPDATES_RAYS
#define WRITES_HITS
#define UPDATES_STATES
#define UPDATES_RAY_COUNTS
#include "access/catcher.glsl"
#include "access/path_time.glsl"
#include "access/paths.glsl"
#include "access/scattering.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

// Traces the path through media that scatter, until it meets something else, ends or has taken as many steps as a dispatch may take.
void walk(uint slot, SampleId id)
{
    PathRay ray = fetchRay(slot);
    PathState state = fetchState(slot);
    PathHit hit = PathHit(kScatteredRef, 0.0, vec2(0.0));
    Steps steps = Steps(0u, 0u);
    uint rays = 0u;
    bool goesOn;
    do {
        float freePath = sampleFreePath(id, ray, state);
        AlphaRay alphaRay = makeAlphaRay(ray);
        alphaRay.query.tMax = reachOf(ray, freePath);
        alphaRay.query.sides = sidesOfRay(slot, state.bounce);
        VisibleHit visible = traceThroughAlpha(id, rayNumber(state), alphaRay, steps);
        ++rays;
        PathHit met = meetFirst(ray, visible.hit, freePath);
        state.throughput = throughputAt(ray, met, state.throughput) * visible.weight;
        goesOn = false;
        if (isScattered(met)) {
            LearnedVertex learned;
            goesOn = scatterPath(id, met.t, ray, state, learned);
            state.throughput = goesOn ? state.throughput : vec3(0.0);
        } else {
            hit = met;
        }
    } while (goesOn && steps.nodes + steps.primitives < kStepsPerThread);
    storeHit(slot, hit);
    storeRay(slot, ray);
    storeState(slot, state);
    countRays(rays - 1u, 0u);  // beside the first
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u) {
        checkPaths();
        countRays(activePaths(), 0u);
    }
    if (entry < activePaths()) {
        uint slot = activeQueue[entry];
        SampleId id = makeSampleId(slot);
        beginPath(id);
        Steps uncounted = Steps(0u, 0u);
        if (hasFeature(kFeatureScattering)) {
            walk(slot, id);
        } else {
            VisibleHit visible = traceVisible(id, pass.bounce, fetchRay(slot), sidesOfRay(slot, pass.bounce), uncounted);
            storeHit(slot, visible.hit);
            if (hasFeature(kFeatureThinWalls)) {
                stateWords[2u * slot].xyz = floatBitsToUint(fetchState(slot).throughput * visible.weight);
            }
        }
    }
    checkLoopBudget(render.canarySteps);
}
