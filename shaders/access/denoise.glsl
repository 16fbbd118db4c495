// A band of the noisy picture, and what the denoiser makes of it. The push constants are not those of a pass that traces.
#ifndef GLIM_ACCESS_DENOISE
#define GLIM_ACCESS_DENOISE

#include "shared/bindings.h"
#include "shared/denoise_types.h"

layout(push_constant, scalar) uniform DenoiseBlock { DenoisePass pass; };
layout(local_size_x_id = kSpecWorkgroup) in;

layout(set = 0, binding = kBindNoisy, scalar) readonly buffer NoisyBuffer { NoisyPixel noisy[]; };
layout(set = 0, binding = kBindPooled, scalar) buffer PooledBuffer { vec3 pooled[]; };
layout(set = 0, binding = kBindDistances, scalar) buffer DistancesBuffer { float distances[]; };  // kWindowWidth for each pixel
layout(set = 0, binding = kBindSums, scalar) buffer SumsBuffer { WeightedSum sums[]; };

bool isInBand(ivec2 at)
{
    return at.x >= 0 && at.y >= 0 && at.x < int(pass.width) && at.y < int(pass.height);
}

// From a pixel to the i-th of the row of its window that the pass is about.
ivec2 getWindowOffset(int i)
{
    return ivec2(i, int(pass.windowRow)) - kWindowRadius;
}

uint pixelAt(ivec2 at)
{
    return uint(at.y) * pass.width + uint(at.x);
}

ivec2 getPixelPosition(uint pixel)
{
    return ivec2(int(pixel % pass.width), int(pixel / pass.width));
}

#endif
