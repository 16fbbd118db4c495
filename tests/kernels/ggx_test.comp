// One thread is one pair of directions and one roughness. Result: errors over tolerances.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/ggx.glsl"

struct Case {
    vec3 wo, wi;
    vec2 alpha;
    float eval, evalTolerance, pdf, pdfTolerance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float eval = evalGgx(c.wo, c.wi, c.alpha), pdf = pdfGgx(c.wo, c.wi, c.alpha);
        EXPECT_NEAR(eval, c.eval, c.evalTolerance);
        EXPECT_NEAR(pdf, c.pdf, c.pdfTolerance);
        results[TEST_THREAD] = abs(vec2(eval - c.eval, pdf - c.pdf)) / vec2(c.eval, c.pdf);
    }
    endTest();
}
