// One thread is one sample of the map, and one direction. Results: what both give.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/environment_map.glsl"

struct Case {
    uvec2 u;  // random words
    vec3 w;  // unit
};

struct Result {
    vec3 w;  // sampled
    float pdf, pdfAgain;
    vec3 radiance;
    vec3 radianceAtW;
    float pdfAtW;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float pdf;
        vec3 w = sampleEnvironmentMap(c.u, pdf);
        EXPECT_NEAR(dot(w, w), 1.0, 1e-6);
        EXPECT_TRUE(pdf > 0.0 && !isinf(pdf));
        EXPECT_NEAR_VECTOR(worldFromMap(mapFromWorld(c.w)), c.w, 3e-7);
        EXPECT_NEAR_VECTOR(mapFromWorld(worldFromMap(c.w)), c.w, 3e-7);
        results[TEST_THREAD] =
            Result(w, pdf, pdfEnvironmentMap(w), environmentRadiance(w), environmentRadiance(c.w), pdfEnvironmentMap(c.w));
    }
    endTest();
}
