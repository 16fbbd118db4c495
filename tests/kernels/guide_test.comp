// One thread is one point with a normal. Samples the guide there by `u`, and evaluates it there and at `w`.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/guide.glsl"

struct Case {
    vec3 p, n;
    vec2 u;
    vec3 w;
};

struct Result {
    vec3 sampled;
    float pdf;        // as the sample has it
    float evaluated;  // for the same direction
    float pdfOfW;
    float share;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Guide guide = fetchGuide(c.p, c.n);
        Result result;
        GuideSample guided = sampleGuideOr(guide, true, c.u, c.n);
        result.sampled = guided.w;
        result.pdf = guided.pdf;
        result.evaluated = pdfGuide(guide, result.sampled);
        result.pdfOfW = pdfGuide(guide, c.w);
        result.share = guide.share;
        EXPECT_TRUE(abs(length(result.sampled) - 1.0) < 1e-6);
        results[TEST_THREAD] = result;
    }
    endTest();
}
