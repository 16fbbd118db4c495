// One thread is one entry of the active queue. Finds what its ray meets first, by the triangle test that the render asks for. Brute force
// takes several dispatches, each of which goes on from the closest hit so far.
// Reads the scene, the queue, rays. Writes hits (brute force also reads them). Updates ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_ROUNDS
#define READS_RAYS
#define UPDATES_HITS
#define UPDATES_RAY_COUNTS
#include "access/course/round.glsl"
#include "access/course/scan.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"

PathHit scanRefs(uint slot)
{
    PathHit met = makePathHit(makeMiss());
    if (lightRound.firstRef > 0u) {
        met = fetchHit(slot);
    }
    return scanClosest(fetchRay(slot), met, lightRound.firstRef, lightRound.endRef);
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u && lightRound.firstRef == 0u) {
        checkPaths();
        countRays(activePaths(), 0u);
    }
    if (entry < activePaths()) {
        uint slot = activeQueue[entry];
        Steps uncounted = Steps(0u, 0u);
        storeHit(slot, kBruteForce ? scanRefs(slot) : traceVisible(makeSampleId(slot), pass.bounce, fetchRay(slot), uncounted).hit);
    }
    checkLoopBudget(render.canarySteps);
}
