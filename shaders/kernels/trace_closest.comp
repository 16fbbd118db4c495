// One thread is one entry of the active queue. Finds what its ray meets first.
// Reads the scene, the queue, rays. Writes hits. Updates states, ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_ROUNDS
#define READS_RAYS
#define WRITES_HITS
#define UPDATES_STATES
#define UPDATES_RAY_COUNTS
#include "access/catcher.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u) {
        checkPaths();
        countRays(activePaths(), 0u);
    }
    if (entry < activePaths()) {
        uint slot = activeQueue[entry];
        Steps uncounted = Steps(0u, 0u);
        VisibleHit visible = traceVisible(makeSampleId(slot), pass.bounce, fetchRay(slot), sidesOfRay(slot, pass.bounce), uncounted);
        storeHit(slot, visible.hit);
        if (hasFeature(kFeatureThinWalls)) {
            stateWords[2u * slot].xyz = floatBitsToUint(fetchState(slot).throughput * visible.weight);
        }
    }
    checkLoopBudget(render.canarySteps);
}
