// One thread is one direction at one surface, with the random numbers of one sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/bsdf/dielectric.glsl"
#include "lib/bsdf/lambert.glsl"
#include "lib/bsdf/mirror.glsl"

struct Case {
    vec3 albedo;
    float cosine;    // of wi against the shading normal, of either sign
    vec2 u;
    float uLobe;
    vec3 n;          // unit; woAt on its side
    vec3 woAt;
    vec3 mirrored;   // expected
    float schlick;   // the fifth power of 1 - cosine
    float ior;
    vec2 reflected;  // expected share from outside, from inside
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        // Lambert: the sample's weight is eval / pdf, which is the albedo; nothing crosses the surface.
        BsdfSample s = sampleLambert(c.albedo, c.u);
        vec3 eval = evalLambert(c.albedo, s.wi);
        EXPECT_EQUAL(s.pdf, pdfLambert(s.wi));
        EXPECT_TRUE(s.wi.z > 0.0 ? s.weight == c.albedo : s.weight == vec3(0.0));
        EXPECT_TRUE(!(s.wi.z > 0.0) || distance(eval / s.pdf, c.albedo) <= 4e-7);
        EXPECT_TRUE(s.eta == 1.0 && s.flags == 0u);
        vec3 wi = vec3(sqrt(1.0 - c.cosine * c.cosine), 0.0, c.cosine);
        EXPECT_NEAR_VECTOR(evalLambert(c.albedo, wi), max(c.cosine, 0.0) * c.albedo / 3.14159265, 1e-7);
        EXPECT_NEAR(pdfLambert(wi), c.cosine > 0.0 ? c.cosine / 3.14159265 : 0.0, 1e-7);
        // Mirror.
        BsdfSample m = sampleMirror(c.albedo, c.woAt, c.n);
        EXPECT_NEAR_VECTOR(m.wi, c.mirrored, 1e-6);
        EXPECT_NEAR_VECTOR(m.weight, c.albedo + (1.0 - c.albedo) * c.schlick, 3e-6);
        EXPECT_TRUE(m.pdf == 0.0 && m.eta == 1.0 && m.flags == kBsdfDelta);
        // Dielectric: reflects where uLobe is below the reflected share, else refracts, with radiance scaled by 1 / eta^2.
        for (uint side = 0u; side < 2u; ++side) {
            float eta = side == 0u ? c.ior : 1.0 / c.ior;
            float share = side == 0u ? c.reflected.x : c.reflected.y;
            BsdfSample g = sampleDielectric(c.albedo, eta, c.woAt, c.n, c.uLobe);
            bool mirrors = dot(g.wi, c.n) > 0.0;
            EXPECT_TRUE(abs(c.uLobe - share) < 1e-4 || dot(c.woAt, c.n) < 1e-3 || mirrors == (c.uLobe < share));
            EXPECT_EQUAL(g.eta, mirrors ? 1.0 : eta);
            EXPECT_EQUAL(g.flags, mirrors ? kBsdfDelta : kBsdfDelta | kBsdfTransmission);
            EXPECT_NEAR_VECTOR(g.weight * (g.eta * g.eta), mirrors ? vec3(1.0) : c.albedo, 1e-6);
            EXPECT_EQUAL(g.pdf, 0.0);
            EXPECT_TRUE(!mirrors || distance(g.wi, c.mirrored) <= 1e-6);
            // Snell: both sines, and the same plane of incidence.
            vec3 sines = cross(c.n, g.wi) * eta + cross(c.n, c.woAt);
            EXPECT_TRUE(mirrors || length(sines) <= 3e-6);
        }
    }
    endTest();
}
