// One thread is one light: the probability that it is chosen for a receiver.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light_choice.glsl"

struct Case {
    vec3 p;
    vec3 receiverNormal;
    uint sight;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { float results[]; };

void main()
{
    if (isTestThread()) {
        LightContext context = LightContext(cases[0].p, vec3(0.0), cases[0].receiverNormal, cases[0].sight);
        results[TEST_THREAD] = computeLightProbability(context, TEST_THREAD);
        EXPECT_TRUE(results[TEST_THREAD] > 0.0);
    }
    endTest();
}
