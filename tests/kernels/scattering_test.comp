// One thread is one throughput in one medium, and numbers that choose distance and direction. Result: the cosine of the deflection, the
// free path at an extinction of 2, the channel that was chosen, and how dense deflections are there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/scattering.glsl"

struct Case {
    vec3 throughput, extinction, albedo;
    float t, anisotropy;
    vec3 direction;
    vec3 u;
    vec3 scattered, reached;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec4 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 scattered = scatteredThroughput(c.throughput, c.extinction, c.albedo, c.t);
        vec3 reached = reachedThroughput(c.throughput, c.extinction, c.t);
        EXPECT_NEAR_VECTOR(scattered, c.scattered, 1e-5 * length(c.scattered));
        EXPECT_NEAR_VECTOR(reached, c.reached, 1e-5 * length(c.reached));
        EXPECT_CLOSE(sumOfChannels(reached), sumOfChannels(c.throughput), 1e-6);
        uint channel = chooseChannel(c.throughput, c.u.z);
        EXPECT_TRUE(c.throughput[channel] > 0.0);
        vec3 w = deflect(c.direction, c.anisotropy, c.u.xy);
        EXPECT_CLOSE(dot(w, w), 1.0, 4e-7);
        EXPECT_NEAR(dot(w, c.direction), sampleDeflection(c.anisotropy, c.u.x), 2e-6);
        EXPECT_TRUE(isinf(sampleFreePath(0.0, c.u.x)));
        results[TEST_THREAD] = vec4(dot(w, c.direction), sampleFreePath(2.0, c.u.x), float(channel), pdfOfDeflection(c.anisotropy, dot(w, c.direction)));
    }
    endTest();
}
