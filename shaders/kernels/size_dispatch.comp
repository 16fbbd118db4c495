// One thread in all. Turns the lengths of the queues just filled into the sizes of the dispatches over them, and empties the
// tails. At the start of a pass (bounce 0 comes with all slots queued) generate_rays has filled the queue itself.
// Reads and writes queue tails; writes queue sizes; adds to the ray counts and, for queues that are too long, to the status.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_QUEUE_SIZES
#define UPDATES_QUEUE_TAILS
#define UPDATES_RAY_COUNTS
#include "access/paths.glsl"
#include "access/status.glsl"

uint groupsOf(uint count)
{
    return (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
}

uvec2 add64(uvec2 sum, uint more)
{
    uint carry;
    sum.x = uaddCarry(sum.x, more, carry);
    return uvec2(sum.x, sum.y + carry);
}

void main()
{
    if (gl_GlobalInvocationID.x == 0u) {
        uint slots = pass.pixelCount * pass.sampleCount;
        uint closest = pass.bounce == 0u ? slots : checkQueue(queueTails.next, slots);
        uint shadow = checkQueue(queueTails.shadow, slots);
        queueSizes.closest = closest;
        queueSizes.shadow = shadow;
        queueSizes.closestGroups = uvec3(groupsOf(closest), 1u, 1u);
        queueSizes.shadowGroups = uvec3(groupsOf(shadow), 1u, 1u);
        queueTails = QueueTails(0u, 0u);
        rayCounts.closest = add64(rayCounts.closest, closest);
        rayCounts.shadow = add64(rayCounts.shadow, shadow);
    }
    checkLoopBudget(pass.canarySteps);
}
