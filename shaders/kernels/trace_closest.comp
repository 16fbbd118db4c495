// One thread is one entry of the active queue. Finds what its ray meets first.
// Reads the scene, the queue, rays. Writes hits. Updates states.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define READS_RAYS
#define WRITES_HITS
#define UPDATES_STATES
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

void main()
{
    uint entry = interleavedInvocation();
    if (entry < queueSizes.closest) {
        uint slot = activeQueue[entry];
        Steps uncounted = Steps(0u, 0u);
        VisibleHit visible = traceVisible(makeSampleId(slot), pass.bounce, fetchRay(slot), uncounted);
        pathHits[slot] = visible.hit;
        if (hasFeature(kFeatureThinWalls)) {
            pathStates[slot].throughput = fetchState(slot).throughput * visible.weight;
        }
    }
    checkLoopBudget(render.canarySteps);
}
