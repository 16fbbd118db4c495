// One thread is one material and one pair of directions. Result: the largest error relative to the value and to the tolerance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "material_case.glsl"

struct Case {
    vec3 wo, wi;
    MaterialCase material;
    vec3 value, tolerance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 f = evalPrincipled(makePrincipled(c.material, c.wo), c.wo, c.wi).f;
        EXPECT_NEAR(f.r, c.value.r, c.tolerance.r);
        EXPECT_NEAR(f.g, c.value.g, c.tolerance.g);
        EXPECT_NEAR(f.b, c.value.b, c.tolerance.b);
        results[TEST_THREAD] = vec2(greatest(abs(f - c.value) / max(c.value, 1e-6)), greatest(abs(f - c.value) / c.tolerance));
    }
    endTest();
}
