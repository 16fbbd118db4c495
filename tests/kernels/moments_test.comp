// One thread is one page: the samples of its blocks summed and folded, in the order in which kernels/accumulate.comp does it.
// Result: the page's moments.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/moments.glsl"
#include "shared/limits.h"

const uint kBlocks = kPageSamples / kBlockSamples;

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { vec3 samples[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { PixelMoments results[]; };

void main()
{
    if (isTestThread()) {
        PixelMoments page = momentsOfBlock(emptyBlock());
        EXPECT_TRUE(page.count == 0u && page.blocks == 0u && isinf(page.depth) && page.mean == vec3(0.0));
        EXPECT_TRUE(foldMoments(page, page).count == 0u && !isnan(foldMoments(page, page).mean.x));
        for (uint block = 0u; block < kBlocks; ++block) {
            BlockSums sums = emptyBlock();
            for (uint i = 0u; i < kBlockSamples; ++i) {
                vec3 s = samples[TEST_THREAD * kPageSamples + block * kBlockSamples + i];
                sums = BlockSums(sums.count + 1u, sums.radiance + s, sums.alpha + s.x, sums.albedo + s.yzx,
                                 sums.normal + s.zxy, min(sums.depth, s.y), sums.clamped + s.z);
            }
            page = foldMoments(page, momentsOfBlock(sums));
        }
        EXPECT_EQUAL(page.count, kPageSamples);
        EXPECT_EQUAL(page.blocks, kBlocks);
        results[TEST_THREAD] = page;
    }
    endTest();
}
