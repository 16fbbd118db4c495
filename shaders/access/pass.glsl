// The push constants of a pass, and which pixel and sample a slot stands for.
#ifndef GLIM_ACCESS_PASS
#define GLIM_ACCESS_PASS

#include "features.glsl"
#include "lib/sampler.glsl"
#include "parameters.glsl"
#include "shared/path_types.h"

// The course's kernels add a round.
#if !defined(PUSH_CONSTANTS)
#define PUSH_CONSTANTS Pass pass;
#endif
layout(push_constant, scalar) uniform PassBlock { PUSH_CONSTANTS };

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

// The device's threads may take contiguous halves of a dispatch (those of a CPU do, without work stealing). So neighbouring groups go to
// different halves: an uneven picture keeps both busy.
uint interleavedInvocation()
{
    uint groups = gl_NumWorkGroups.x;
    uint halfCount = (groups + 1u) / 2u;
    uint id = gl_WorkGroupID.x;
    uint group = id < halfCount ? 2u * id : 2u * (id - halfCount) + 1u;
    return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}

// Index in the tile of the pass's pixel number `i`.
uint getPassPixel(uint i)
{
    return kChosen ? chosenPixels[pass.firstPixel + i].pixel : pass.firstPixel + i;
}

// First sample of the pass's pixel number `i`.
uint getFirstSample(uint i)
{
    return kChosen ? chosenPixels[pass.firstPixel + i].samplesBefore + pass.firstSample : pass.firstSample;
}

uint samplesOfPass()
{
    return pass.pixelCount * pass.sampleCount;
}

// Paths of a pass. With kFeatureCatcher each sample has another one, whose slot is that of the first plus samplesOfPass()
// (access/catcher.glsl).
uint slotsOfPass()
{
    return hasFeature(kFeatureCatcher) ? 2u * samplesOfPass() : samplesOfPass();
}

SampleId makeSampleId(uint slot)
{
    if (hasFeature(kFeatureCatcher) && slot >= samplesOfPass()) {
        slot -= samplesOfPass();
    }
    uint pixel = slot / pass.sampleCount;
    return SampleId(render.seed, pass.tileBegin + getPassPixel(pixel),
                    getFirstSample(pixel) + (slot - pixel * pass.sampleCount));
}

#endif
