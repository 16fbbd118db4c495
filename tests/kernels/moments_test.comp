// One thread is one stream of blocks, folded into a page.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/moments.glsl"

const uint kBlocks = 8u;

struct Case {
    BlockSums blocks[kBlocks];
    PixelMoments expected;  // by the host's foldMoments
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

bool sameBits(PixelMoments a, PixelMoments b)
{
    return a.count == b.count && a.blocks == b.blocks && a.mean == b.mean && a.squares == b.squares && a.alpha == b.alpha &&
           a.albedo == b.albedo && a.normal == b.normal && a.depth == b.depth && a.clamped == b.clamped;
}

void main()
{
    if (isTestThread()) {
        PixelMoments page = computeBlockMoments(emptyBlock());
        EXPECT_EQUAL(page.count, 0u);
        EXPECT_EQUAL(page.blocks, 0u);
        for (uint i = 0u; i < kBlocks; ++i) {
            page = foldMoments(page, computeBlockMoments(cases[TEST_THREAD].blocks[i]));
        }
        EXPECT_TRUE(sameBits(page, cases[TEST_THREAD].expected));
        EXPECT_TRUE(sameBits(foldMoments(page, computeBlockMoments(emptyBlock())), page));
    }
    endTest();
}
