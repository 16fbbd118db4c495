// One thread is one path about to play.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/fixed_roulette.glsl"
#include "lib/roulette.glsl"

struct Case {
    vec3 throughput;
    float etaScale;
    uint bounce;
    float survival;
    float q, survivalOfQ;  // the fixed rule
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float survival = continuationProbability(c.throughput, c.etaScale, c.bounce);
        EXPECT_CLOSE(survival, c.survival, 2e-7);
        EXPECT_EQUAL(fixedContinuation(c.q, c.bounce), c.survivalOfQ);
        // H24: the weight after roulette never exceeds the larger of 1 and the weight before.
        vec3 after = c.throughput / survival * c.etaScale;
        vec3 before = c.throughput * c.etaScale;
        EXPECT_TRUE(max(after.r, max(after.g, after.b)) <= 1.000001 * max(1.0, max(before.r, max(before.g, before.b))));
    }
    endTest();
}
