// One thread is one direction at one surface, and the numbers for one sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/scatter.glsl"

struct Case {
    vec3 albedo;
    float cosine;    // of wi against the shading normal, of either sign
    vec2 u;
    float fate;
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
        // Lambert: what is sampled has the weight eval * cosine / pdf, which is the albedo; nothing crosses the surface.
        Scatter s = sampleLambert(c.albedo, c.u);
        vec3 eval = evalLambert(c.albedo, s.wi.z);
        EXPECT_EQUAL(s.pdf, pdfLambert(s.wi.z));
        EXPECT_TRUE(s.wi.z > 0.0 ? s.weight == c.albedo : s.weight == vec3(0.0));
        EXPECT_TRUE(!(s.wi.z > 0.0) || distance(eval * s.wi.z / s.pdf, c.albedo) <= 4e-7);
        EXPECT_EQUAL(s.etaScale, 1.0);
        EXPECT_NEAR_VECTOR(evalLambert(c.albedo, c.cosine), c.cosine > 0.0 ? c.albedo / 3.14159265 : vec3(0.0), 1e-7);
        EXPECT_NEAR(pdfLambert(c.cosine), c.cosine > 0.0 ? c.cosine / 3.14159265 : 0.0, 1e-7);
        // Mirror.
        Scatter m = sampleMirror(c.albedo, c.woAt, c.n);
        EXPECT_NEAR_VECTOR(m.wi, c.mirrored, 1e-6);
        EXPECT_NEAR_VECTOR(m.weight, c.albedo + (1.0 - c.albedo) * c.schlick, 3e-6);
        EXPECT_TRUE(m.pdf == 0.0 && m.etaScale == 1.0);
        // Glass: reflects where fate is below the reflected share, else passes, squeezed by the square of the index.
        for (uint side = 0u; side < 2u; ++side) {
            float scale = side == 0u ? c.ior * c.ior : 1.0 / (c.ior * c.ior);
            float share = side == 0u ? c.reflected.x : c.reflected.y;
            Scatter g = sampleGlass(c.albedo, c.ior, side == 0u, c.woAt, c.n, c.fate);
            bool mirrors = dot(g.wi, c.n) > 0.0;
            EXPECT_TRUE(abs(c.fate - share) < 1e-4 || dot(c.woAt, c.n) < 1e-3 || mirrors == (c.fate < share));
            EXPECT_CLOSE(g.etaScale, mirrors ? 1.0 : scale, 1e-6);
            EXPECT_NEAR_VECTOR(g.weight * g.etaScale, mirrors ? vec3(1.0) : c.albedo, 1e-6);
            EXPECT_EQUAL(g.pdf, 0.0);
            EXPECT_TRUE(!mirrors || distance(g.wi, c.mirrored) <= 1e-6);
            // Snell: both sines, and the same plane of incidence.
            vec3 sines = cross(c.n, g.wi) * (side == 0u ? c.ior : 1.0 / c.ior) + cross(c.n, c.woAt);
            EXPECT_TRUE(mirrors || length(sines) <= 3e-6);
        }
    }
    endTest();
}
