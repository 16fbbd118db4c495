// Each thread queues an entry for the next round, and every third one a shadow ray. Thread 0 counts the rays of the round.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_NEXT_QUEUE
#define WRITES_SHADOW_QUEUE
#define UPDATES_ROUNDS
#define UPDATES_RAY_COUNTS
#include "expect.glsl"
#include "access/queues.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint shares[]; };

void main()
{
    if (isTestThread()) {
        uint share = shares[TEST_THREAD];
        queuePath(1000u + TEST_THREAD, share);
        if (TEST_THREAD % 3u == 0u) {
            queueShadowRay(TEST_THREAD);
        }
        if (TEST_THREAD == 0u) {
            checkPaths();
            checkShadowRays();
            countRays(activePaths(), activePaths() + 1u);
        }
        EXPECT_TRUE(share > 0u);
    }
    endTest();
}
