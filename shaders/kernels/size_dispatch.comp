// One thread in all. Turns the length of the queue that was just filled, of paths or of shadow rays as the pass says, into the size of
// the dispatches over it and, once no path is alive, over the pass's pixels, and resets its tail. At the start of a pass (bounce 0)
// generate_rays has queued all slots.
// Reads and writes queue tails; writes queue sizes; adds to the ray counts and, for queues that are too long, to the status.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_QUEUE_SIZES
#define UPDATES_QUEUE_TAILS
#define UPDATES_RAY_COUNTS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/add64.glsl"

uint countGroups(uint count, uint share)
{
    uint groupEntries = gl_WorkGroupSize.x * share;
    return (count + groupEntries - 1u) / groupEntries;
}

uint takePaths(uint slots, uint share)
{
    uint count = pass.bounce == 0u ? slots : checkQueue(queueTails.next, slots);
    queueSizes.closest = count;
    queueSizes.closestGroups = uvec3(countGroups(count, share), 1u, 1u);
    queueSizes.endGroups = uvec3(count == 0u ? countGroups(pass.pixelCount, 1u) : 0u, 1u, 1u);
    if (count > 0u) {
        queueSizes.lastBounce = pass.bounce;
    }
    queueTails.next = 0u;
    return count;
}

void sizeShadow(uint slots)
{
    uint count = checkQueue(queueTails.shadow, slots);
    queueSizes.shadow = count;
    queueSizes.shadowGroups = uvec3(countGroups(count, 1u), 1u, 1u);
    queueTails.shadow = 0u;
    rayCounts.shadow = add64(rayCounts.shadow, uvec2(count, 0u));
}

void main()
{
    if (gl_GlobalInvocationID.x == 0u) {
        uint slots = pass.pixelCount * pass.sampleCount;
        if ((pass.sizes & kSizesPaths) != 0u) {
            rayCounts.closest = add64(rayCounts.closest, uvec2(takePaths(slots, 1u), 0u));
        }
        if ((pass.sizes & kSizesShares) != 0u) {
            takePaths(slots, kPathsPerThread);
        }
        if ((pass.sizes & kSizesShadow) != 0u) {
            sizeShadow(slots);
        }
    }
    checkLoopBudget(render.canarySteps);
}
