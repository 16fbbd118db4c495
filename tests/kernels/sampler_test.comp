// One thread is one sample id and dimension. Result: its pair of numbers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/split_sample.glsl"

struct Case {
    uint seed, pixel, index, dimension;
    uint sobol;
    uint light, k, count;  // number k of count samples of a light; count 0: not split
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SampleId id = SampleId(c.seed, c.pixel, c.index);
        if (c.count > 0u) {
            id = splitSample(id, c.light, c.k, c.count);
        }
        uvec2 pair = samplePair(id, c.dimension, c.sobol != 0u);
        // After the pixel's dimension and four bounces of four.
        bool late = c.dimension >= 1u + 4u * 4u && c.dimension != kDimensionLens;
        EXPECT_TRUE(c.sobol != 0u && !late || pair == independentPair(id, c.dimension));
        EXPECT_TRUE(c.sobol == 0u || late || pair != independentPair(id, c.dimension));
        // No two uses share a dimension.
        uint bounce = TEST_THREAD % 64u;
        uint uses[4] = uint[](kDimensionLight, kDimensionPoint, kDimensionBsdf, kDimensionLobe);
        for (uint k = 0u; k < 4u; ++k) {
            EXPECT_EQUAL(bounceDimension(bounce, uses[k]), 1u + 4u * bounce + k);
        }
        EXPECT_TRUE(kDimensionPixel == 0u && kDimensionLens == 0xffffffffu);
        results[TEST_THREAD] = pair;
    }
    endTest();
}
