// Turns the sums of a block into moments, and folds moments. host/render/film.cpp does the same for pages.
#ifndef GLIM_LIB_MOMENTS
#define GLIM_LIB_MOMENTS

#include "infinity.glsl"
#include "shared/path_types.h"
#include "shared/pixel_moments.h"

BlockSums emptyBlock()
{
    return BlockSums(0u, vec3(0.0), 0.0, vec3(0.0), vec3(0.0), kInfinity, 0.0);
}

PixelMoments momentsOfBlock(BlockSums sums)
{
    float share = sums.count > 0u ? 1.0 / float(sums.count) : 0.0;
    return PixelMoments(sums.count, min(sums.count, 1u), sums.radiance * share, vec3(0.0), sums.alpha * share,
                        sums.albedo * share, sums.normal * share, sums.depth, sums.clamped * share);
}

// Chan, Golub, LeVeque, "Algorithms for Computing the Sample Variance", 1983.
PixelMoments foldMoments(PixelMoments a, PixelMoments b)
{
    if (a.count == 0u) {
        return b;
    }
    if (b.count == 0u) {
        return a;
    }
    uint count = a.count + b.count;
    float share = float(b.count) / float(count);
    vec3 delta = b.mean - a.mean;
    return PixelMoments(count, a.blocks + b.blocks, a.mean + delta * share,
                        (a.squares + b.squares) + (delta * delta) * (float(a.count) * share),
                        a.alpha + (b.alpha - a.alpha) * share, a.albedo + (b.albedo - a.albedo) * share,
                        a.normal + (b.normal - a.normal) * share, min(a.depth, b.depth),
                        a.clamped + (b.clamped - a.clamped) * share);
}

#endif
