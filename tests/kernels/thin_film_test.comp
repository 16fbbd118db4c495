// One thread is one film over one base. Result: the largest error.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/thin_film.glsl"

struct Case {
    float cosine, ior, thickness;
    vec3 baseF0;
    vec3 reflectance, tolerance;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 f = filmReflectance(c.cosine, c.ior, c.thickness, c.baseF0);
        EXPECT_NEAR(f.r, c.reflectance.r, c.tolerance.r);
        EXPECT_NEAR(f.g, c.reflectance.g, c.tolerance.g);
        EXPECT_NEAR(f.b, c.reflectance.b, c.tolerance.b);
        vec3 error = abs(f - c.reflectance);
        results[TEST_THREAD] = vec2(max(error.r, max(error.g, error.b)), 0.0);
    }
    endTest();
}
