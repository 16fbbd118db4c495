// One thread is one slot. It reads and writes every buffer of paths.glsl. Each holds other values: the host has filled those that
// are read here, and knows what the others must hold afterwards.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_SHADOW_QUEUE
#define READS_RAYS
#define READS_SHADOW_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define UPDATES_ROUNDS
#define UPDATES_RAY_COUNTS
#define UPDATES_HITS
#define WRITES_FIRST_HITS
#define WRITES_NEXT_QUEUE
#include "expect.glsl"
#include "access/paths.glsl"

void main()
{
    uint slot = TEST_THREAD;
    if (slot < rounds[2].paths.count) {
        float f = float(slot);
        EXPECT_EQUAL(activeQueue[slot], 3000u + slot);
        EXPECT_EQUAL(shadowQueue[slot], 4000u + slot);
        EXPECT_EQUAL(rounds[2].shadowRays.groups.z, 77u);
        EXPECT_EQUAL(fetchRay(slot).source, 5000u + slot);
        EXPECT_EQUAL(fetchShadowRay(slot).target, 6000u + slot);
        EXPECT_EQUAL(fetchHit(slot).primitiveRef, 8000u + slot);
        PathState state = fetchState(slot);
        state.pdf += f;
        storeState(slot, state);
        PathRadiance radiance = fetchRadiance(slot);
        radiance.clamped += 2.0 * f;
        storeRadiance(slot, radiance);
        storeHit(slot, PathHit(slot, 3.0 * f, vec2(0.25, 0.5)));
        storeFirstHit(slot, FirstHit(vec3(0.5), 1.0, vec3(0.0, 1.0, 0.0), 4.0 * f));
        nextQueue[slot] = 7000u + slot;
        atomicAdd(rounds[1].shadowRays.count, 1u);
        atomicAdd(rayCounts.closest.y, 2u);
    }
    endTest();
}
