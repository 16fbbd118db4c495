// One thread is one stream of blocks, folded into a page.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/moments.glsl"

const uint kBlocks = 8u;

struct Case {
    BlockSums blocks[kBlocks];
    PixelMoments expected;  // by the host's foldMoments
    CatcherSums catchers[kBlocks];
    CatcherMoments expectedCatcher;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

bool sameBits(PixelMoments a, PixelMoments b)
{
    return a.count == b.count && a.blocks == b.blocks && a.mean == b.mean && a.squares == b.squares && a.alpha == b.alpha &&
           a.albedo == b.albedo && a.normal == b.normal && a.depth == b.depth && a.clamped == b.clamped;
}

bool sameBits(CatcherMoments a, CatcherMoments b)
{
    return a.count == b.count && a.share == b.share && a.with == b.with && a.without == b.without && a.squares == b.squares;
}

void main()
{
    if (isTestThread()) {
        CatcherMoments caught = CatcherMoments(0u, 0.0, vec3(0.0), vec3(0.0), vec3(0.0));
        for (uint i = 0u; i < kBlocks; ++i) {
            CatcherSums sums = cases[TEST_THREAD].catchers[i];
            sums.page = caught;
            sums = foldCatcher(sums, cases[TEST_THREAD].blocks[i].count);
            caught = sums.page;
            EXPECT_EQUAL(sums.with, vec3(0.0));
        }
        EXPECT_TRUE(sameBits(caught, cases[TEST_THREAD].expectedCatcher));
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
