// One thread is one direction at one interface.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/fresnel.glsl"

struct Case {
    float cosine, eta;
    float reflected, tolerance;   // expected
    float beyond;                 // cosine on the other side; < 0: total, or too near to it to come back
    vec3 color, schlick;
    vec3 wo, n, mirrored, passed;
    float passedTolerance;        // < 0: total reflection
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float f = fresnelDielectric(c.cosine, c.eta);
        EXPECT_TRUE(f >= 0.0 && f <= 1.0);
        EXPECT_NEAR(f, c.reflected, c.tolerance);
        EXPECT_EQUAL(fresnelDielectric(c.cosine, 1.0), 0.0);
        EXPECT_EQUAL(fresnelDielectric(1.0000002, c.eta), fresnelDielectric(1.0, c.eta));
        EXPECT_NEAR_VECTOR(fresnelSchlick(c.color, c.cosine), c.schlick, 1e-6);
        EXPECT_NEAR_VECTOR(reflectAbout(c.wo, c.n), c.mirrored, 1e-6);
        EXPECT_TRUE(refractThrough(c.wo, c.n, 1.0) == -c.wo);
        if (c.beyond >= 0.0) {
            EXPECT_NEAR(fresnelDielectric(c.beyond, 1.0 / c.eta), c.reflected, 1e-5);
        }
        if (c.passedTolerance >= 0.0) {
            vec3 wi = refractThrough(c.wo, c.n, c.eta);
            EXPECT_NEAR(dot(wi, wi), 1.0, 2e-6);
            EXPECT_NEAR_VECTOR(wi, c.passed, c.passedTolerance);
        }
    }
    endTest();
}
