// Which paths and which shadow rays the kernels of a round trace. A kernel says what it does with them before including this:
// READS_ACTIVE_QUEUE, READS_SHADOW_QUEUE, WRITES_NEXT_QUEUE or WRITES_SHADOW_QUEUE, READS_ROUNDS or UPDATES_ROUNDS, UPDATES_RAY_COUNTS.
#ifndef GLIM_ACCESS_QUEUES
#define GLIM_ACCESS_QUEUES

#include "pass.glsl"
#include "status.glsl"

#if defined(UPDATES_ROUNDS)
layout(set = 0, binding = kBindRounds, scalar) buffer RoundsBuffer { Round rounds[]; };
#elif defined(READS_ROUNDS)
layout(set = 0, binding = kBindRounds, scalar) readonly buffer RoundsBuffer { Round rounds[]; };
#endif

#if defined(READS_ROUNDS) || defined(UPDATES_ROUNDS)
uint activePaths()
{
    return min(rounds[pass.round].paths.count, slotsOfPass());
}

uint activeShadowRays()
{
    return min(rounds[pass.round].shadowRays.count, slotsOfPass());
}

// One thread of a dispatch calls this. A kernel queues each slot at most once, so a longer queue has lost entries or counted some twice.
void checkPaths()
{
    reportOverflow(rounds[pass.round].paths.count - activePaths());
}

void checkShadowRays()
{
    reportOverflow(rounds[pass.round].shadowRays.count - activeShadowRays());
}
#endif

#if defined(UPDATES_ROUNDS)
bool needsGroups(uint entry, uint share)
{
    return entry % (kGroupsAtOnce * gl_WorkGroupSize.x * share) == 0u;
}
#endif

#if defined(READS_ACTIVE_QUEUE)
layout(set = 0, binding = kBindActiveQueue, scalar) readonly buffer ActiveQueueBuffer { uint activeQueue[]; };
#endif

#if defined(WRITES_NEXT_QUEUE)
layout(set = 0, binding = kBindNextQueue, scalar) writeonly buffer NextQueueBuffer { uint nextQueue[]; };

#if defined(UPDATES_ROUNDS)
// `share`: paths that a thread of the next round takes.
void queuePath(uint slot, uint share)
{
    uint entry = atomicAdd(rounds[pass.round + 1u].paths.count, 1u);
    nextQueue[entry] = slot;
    if (needsGroups(entry, share)) {
        atomicAdd(rounds[pass.round + 1u].paths.groups.x, kGroupsAtOnce);
    }
}
#endif
#endif

#if defined(READS_SHADOW_QUEUE)
layout(set = 0, binding = kBindShadowQueue, scalar) readonly buffer ShadowQueueBuffer { uint shadowQueue[]; };
#elif defined(WRITES_SHADOW_QUEUE)
layout(set = 0, binding = kBindShadowQueue, scalar) writeonly buffer ShadowQueueBuffer { uint shadowQueue[]; };

void queueShadowRay(uint slot)
{
    uint entry = atomicAdd(rounds[pass.round].shadowRays.count, 1u);
    shadowQueue[entry] = slot;
    if (needsGroups(entry, 1u)) {
        atomicAdd(rounds[pass.round].shadowRays.groups.x, kGroupsAtOnce);
    }
}
#endif

#if defined(UPDATES_RAY_COUNTS)
layout(set = 0, binding = kBindRayCounts, scalar) buffer RayCountsBuffer { RayCounts rayCounts; };

// Called by many threads at once.
void countRays(uint closest, uint shadow)
{
    uint before = atomicAdd(rayCounts.closest.x, closest);
    if (before + closest < before) {
        atomicAdd(rayCounts.closest.y, 1u);
    }
    before = atomicAdd(rayCounts.shadow.x, shadow);
    if (before + shadow < before) {
        atomicAdd(rayCounts.shadow.y, 1u);
    }
}
#endif

#endif
