// One thread is one throughput, and one path in a closed furnace. Result: what the path carries, and its length.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/hash.glsl"
#include "lib/roulette.glsl"

struct Case {
    vec3 throughput;
    float etaScale;
    uint bounce;
    float survival;  // expected
};

struct Result {
    float light;
    uint events;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

// Unit emission everywhere and the albedo that the pass carries: truth 1 / (1 - albedo).
Result walkFurnace(float albedo)
{
    Result result = Result(0.0, 0u);
    float throughput = 1.0;
    bool going = true;
    while (going) {
        result.light += throughput;
        throughput *= albedo;
        float survival = survivalProbability(vec3(throughput), 1.0, result.events);
        going = unitFloat(hash4(uvec4(TEST_THREAD, result.events, pass.seed, 0u)).x) < survival && result.events < 5000u;
        throughput /= survival;
        result.events += 1u;
    }
    return result;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float survival = survivalProbability(c.throughput, c.etaScale, c.bounce);
        EXPECT_CLOSE(survival, c.survival, 1e-7);
        // The brightest channel after surviving is no brighter than before, or than 1 (freed of the glass's compression).
        vec3 kept = c.throughput / survival * c.etaScale;
        float before = max(c.throughput.r, max(c.throughput.g, c.throughput.b)) * c.etaScale;
        EXPECT_TRUE(max(kept.r, max(kept.g, kept.b)) <= max(1.0, before) * 1.000001);
        results[TEST_THREAD] = walkFurnace(pass.environment.x);
    }
    endTest();
}
