// Numbers that host and kernels must agree on.
#ifndef GLIM_SHARED_LIMITS_H
#define GLIM_SHARED_LIMITS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// The most levels of the traversal stack. At most 32, since some drivers unroll no longer loop
// (driver_bugs.md): in a loop, each level would be in memory.
GLIM_CONST uint kMaxStackLevels = 24u;

// A pixel's samples come in blocks, aligned to the absolute sample index. Each block has a scramble of its own, and the variance is
// estimated from the block means. A page is the fold of its blocks, the film the fold of its pages.
GLIM_CONST uint kBlockSamples = 128u;
GLIM_CONST uint kFirstBlockSamples = 32u;
GLIM_CONST uint kPageSamples = 256u;

// Primitive references that brute force tries per dispatch: some drivers have a loop budget (driver_bugs.md).
GLIM_CONST uint kScanPrimitiveRefs = 8192u;

// Once a thread of trace_paths has visited nodes and tested primitives kStepsPerThread times, it begins no further ray. What is left goes
// into the next dispatch. Some drivers have a loop budget for all lanes together (driver_bugs.md). With ten million triangles, the first
// dispatch after a cheap sky takes .12 s on two cores; with 4096 steps it would take .35 s. 256 steps take up to a sixth longer in all.
GLIM_CONST uint kStepsPerThread = 512u;

// How often a path scatters in volumes between two surfaces, at most. In a white half-space it would scatter more than n times with a
// probability of 1 / sqrt(pi n), here .0044.
GLIM_CONST uint kMaxScatterings = 16384u;

// How a device rounds is told by so many inputs of so many operations (probe_arithmetic).
GLIM_CONST uint kProbedInputs = 4096u;
GLIM_CONST uint kProbedOperations = 5u;

// After this many equal samples a pixel may count as constant. If one sample in 200 is not black, so many have shown one with probability
// .994. Where no surface is in sight fewer are enough (course_choose_pixels).
GLIM_CONST uint kConstantSamples = 1024u;

// The number of samples in the block of sample `index`: 32, 32, 64, 128, 128 ... Large blocks have less noise, but the error is known from
// two blocks on.
GLIM_FUNCTION uint blockSamples(uint index)
{
    return index < 2u * kFirstBlockSamples ? kFirstBlockSamples : index < kBlockSamples ? kBlockSamples / 2u : kBlockSamples;
}

GLIM_SHARED_END
#endif
