// One thread is one slot: what it writes to each array must be found there, and nowhere else.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_RAYS
#define WRITES_HITS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define WRITES_FIRST_HITS
#define WRITES_SHADOW_RAYS
#define WRITES_NEXT_QUEUE
#define WRITES_SHADOW_QUEUE
#define UPDATES_QUEUE_TAILS
#include "access/paths.glsl"
#include "expect.glsl"

void main()
{
    if (isTestThread()) {
        uint i = TEST_THREAD;
        float x = float(100u * i);
        pathRays[i] = PathRay(vec3(x, x + 1.0, x + 2.0), i + 3u, vec3(x + 4.0, x + 5.0, x + 6.0));
        pathHits[i] = PathHit(i, x + 1.0, vec2(x + 2.0, x + 3.0));
        pathStates[i] = PathState(vec3(x, x + 1.0, x + 2.0), x + 3.0, x + 4.0, x + 5.0);
        pathRadiance[i] = PathRadiance(vec3(x, x + 1.0, x + 2.0), x + 3.0);
        pathFirstHits[i] = FirstHit(vec3(x, x + 1.0, x + 2.0), x + 3.0, vec3(x + 4.0, x + 5.0, x + 6.0), x + 7.0);
        pathShadowRays[i] = ShadowRay(vec3(x), i, vec3(x + 1.0), i + 2u, vec3(x + 3.0), x + 4.0);
        nextQueue[atomicAdd(queueTails.next, 1u)] = i;
        shadowQueue[atomicAdd(queueTails.shadow, 1u)] = i + 1u;
        EXPECT_TRUE(pathRays[i].direction == vec3(x + 4.0, x + 5.0, x + 6.0));
        EXPECT_EQUAL(pathStates[i].etaScale, x + 5.0);
        EXPECT_EQUAL(pathRadiance[i].clamped, x + 3.0);
    }
    endTest();
}
