// One thread is one entry of the active queue. Finds what its ray meets first.
// Reads the scene, the queue, rays. Writes hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define READS_RAYS
#define WRITES_HITS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

void main()
{
    uint entry = interleavedInvocation();
    if (entry < queueSizes.closest) {
        uint slot = activeQueue[entry];
        Steps uncounted = Steps(0u, 0u);
        pathHits[slot] = traceVisible(sampleOfSlot(slot), pass.bounce, fetchRay(slot), uncounted);
    }
    checkLoopBudget(render.canarySteps);
}
