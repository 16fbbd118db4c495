// The push constants of a pass, and which pixel and sample a slot stands for.
#ifndef GLIM_ACCESS_PASS
#define GLIM_ACCESS_PASS

#include "features.glsl"
#include "lib/sampler.glsl"
#include "shared/path_types.h"

layout(push_constant, scalar) uniform PassBlock { Pass pass; };

#if defined(WRITES_CHOSEN_PIXELS)
layout(set = 0, binding = kBindChosenPixels, scalar) buffer ChosenPixelsBuffer {
    uint chosenCount;
    ChosenPixel chosenPixels[];
};
#else
layout(set = 0, binding = kBindChosenPixels, scalar) readonly buffer ChosenPixelsBuffer {
    uint chosenCount;
    ChosenPixel chosenPixels[];
};
#endif

layout(local_size_x_id = kSpecWorkgroup) in;

// The device's threads may take contiguous halves of a dispatch (llvmpipe does, without stealing): neighbouring groups go
// to different halves, so that an uneven picture keeps both busy.
uint interleavedInvocation()
{
    uint groups = gl_NumWorkGroups.x;
    uint half_ = (groups + 1u) / 2u;
    uint id = gl_WorkGroupID.x;
    uint group = id < half_ ? 2u * id : 2u * (id - half_) + 1u;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

// Index in the slab of the pass's pixel number `i`.
uint pixelOfPass(uint i)
{
    return kChosen ? chosenPixels[pass.firstPixel + i].pixel : pass.firstPixel + i;
}

// Of the pass's pixel number `i`.
uint firstSampleOfPass(uint i)
{
    return kChosen ? chosenPixels[pass.firstPixel + i].samplesBefore + pass.firstSample : pass.firstSample;
}

SampleId sampleOfSlot(uint slot)
{
    uint pixel = slot / pass.sampleCount;
    return SampleId(pass.seed, pass.slabBegin + pixelOfPass(pixel),
                    firstSampleOfPass(pixel) + (slot - pixel * pass.sampleCount));
}

#endif
