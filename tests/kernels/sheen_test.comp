// One thread is one pair of directions and one roughness.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/sheen.glsl"

struct Case {
    vec3 wo, wi;
    float alpha;
    float eval, evalTolerance, masking, maskingTolerance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float eval = evalSheen(c.wo, c.wi, c.alpha), masking = sheenMasking(c.wi.z, c.alpha);
        EXPECT_NEAR(eval, c.eval, c.evalTolerance);
        EXPECT_NEAR(masking, c.masking, c.maskingTolerance);
        EXPECT_CLOSE(evalSheen(c.wi, c.wo, c.alpha) * c.wi.z, eval * c.wo.z, 5e-7);  // reciprocity
        results[TEST_THREAD] = abs(vec2(eval - c.eval, masking - c.masking)) / max(vec2(c.eval, c.masking), 1e-30);
    }
    endTest();
}
