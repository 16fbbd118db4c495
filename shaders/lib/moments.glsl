// Turns the sums of a block into moments.
#ifndef GLIM_LIB_MOMENTS
#define GLIM_LIB_MOMENTS

#include "finite.glsl"
#include "shared/path_types.h"
#include "shared/pixel_moments.h"

BlockSums emptyBlock()
{
    return BlockSums(0u, vec3(0.0), 0.0, vec3(0.0), vec3(0.0), kInfinity, 0.0);
}

PixelMoments computeBlockMoments(BlockSums sums)
{
    float share = sums.count > 0u ? 1.0 / float(sums.count) : 0.0;
    return PixelMoments(sums.count, min(sums.count, 1u), sums.radiance * share, vec3(0.0), sums.alpha * share,
                        sums.albedo * share, sums.normal * share, sums.depth, sums.clamped * share);
}

// Moves a block to the page. count: of its samples.
CatcherSums foldCatcher(CatcherSums sums, uint count)
{
    float share = count > 0u ? 1.0 / float(count) : 0.0;
    CatcherMoments block = CatcherMoments(count, sums.share * share, sums.with * share, sums.without * share, vec3(0.0));
    return CatcherSums(0.0, vec3(0.0), vec3(0.0), foldMoments(sums.page, block));
}

#endif
