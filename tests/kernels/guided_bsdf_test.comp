// One thread is one vertex on a Lambert surface: a direction by guide or BSDF, and one towards a light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/guided_bsdf.glsl"

struct Case {
    vec3 p, n;
    vec2 u;
    float uLobe;
    vec3 lightWi;
    uint hasGuide;
};

struct Result {
    vec3 wi;
    float pdf, bsdfPdf, weight, lightPdf;
    float guidePdf, guidePdfOfLight;  // for the same directions
    float share;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Bsdf bsdf;
        bsdf.type = kLambert;
        bsdf.color = vec3(0.5);
        bsdf.eta = 1.0;
        bsdf.frame = makeFrame(c.n);
        bsdf.ng = c.n;
        bsdf.medium = 0u;
        Guide guide = kNoGuide;
        if (c.hasGuide != 0u) {
            guide = fetchGuide(c.p, c.n);
        }
        float uLobe = c.uLobe, bsdfPdf;
        BsdfPair pair = evalAndSampleGuided(bsdf, guide, c.n, c.lightWi, c.u, uLobe, bsdfPdf);
        EXPECT_TRUE(uLobe >= 0.0 && uLobe < 1.0);
        if (c.hasGuide == 0u) {
            BsdfPair plain = evalAndSampleBsdf(bsdf, c.n, c.lightWi, c.u, c.uLobe);
            EXPECT_TRUE(pair.next.wi == plain.next.wi);
            EXPECT_TRUE(pair.next.pdf == plain.next.pdf && pair.next.weight == plain.next.weight);
            EXPECT_TRUE(pair.light.pdf == plain.light.pdf && pair.light.f == plain.light.f);
        }
        results[TEST_THREAD] = Result(pair.next.wi, pair.next.pdf, bsdfPdf, pair.next.weight.x, pair.light.pdf, pdfGuide(guide, pair.next.wi),
                                      pdfGuide(guide, c.lightWi), guide.share);
    }
    endTest();
}
