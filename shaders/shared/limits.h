// Numbers that host and kernels must agree on.
#ifndef GLIM_SHARED_LIMITS_H
#define GLIM_SHARED_LIMITS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Of the traversal stack, at most. No more than 32, the rounds of a loop that Mesa unrolls: in a loop, each level would be memory.
GLIM_CONST uint kMaxStackLevels = 24u;

// Samples of a pixel come in blocks with one scramble each, aligned to the absolute sample index; block means are what
// the variance is estimated from. The first of kBlockSamples is two halves, so that the error is known from there on. A page is
// the fold of its blocks, the film the fold of its pages.
GLIM_CONST uint kBlockSamples = 64u;
GLIM_CONST uint kFirstBlockSamples = 32u;
GLIM_CONST uint kPageSamples = 256u;

// Primitives that brute force tries per dispatch: Mesa before 24 stops loops after 65,535 iterations.
GLIM_CONST uint kScanRecords = 8192u;

// Paths that a thread of trace_paths takes at most, one after the other, and visits to nodes and tests of primitives after which it
// begins no ray. What is left goes into the next dispatch. Eight lanes of Mesa before 24 have 65,535 iterations together; and a pass
// over ten million triangles that comes after a cheap sky then begins with a dispatch of .12 s on two cores, with 4096 of .35 s. 256
// take up to a sixth longer in all.
GLIM_CONST uint kPathsPerThread = 16u;
GLIM_CONST uint kStepsPerThread = 512u;

// Samples without any difference after which a pixel may count as constant: one whose samples are black but for one in 200
// has then been found out with probability .994. Where no surface is in sight fewer do (choose_pixels).
GLIM_CONST uint kConstantSamples = 1024u;

GLIM_SHARED_END
#endif
