// What the denoiser's kernels read.
#ifndef GLIM_SHARED_DENOISE_TYPES_H
#define GLIM_SHARED_DENOISE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Radii of squares around a pixel, in pixels.
GLIM_CONST int kPoolRadius = 2;    // over which the variance is averaged
GLIM_CONST int kPatchRadius = 2;   // that is compared
GLIM_CONST int kWindowRadius = 5;  // whose pixels are averaged
GLIM_CONST int kWindowWidth = 2 * kWindowRadius + 1;

// Rows that one thread of weigh_patches walks down.
GLIM_CONST int kStripRows = 8;

// The rows above and below that the result of a row depends on.
GLIM_CONST int kDenoiseMargin = kWindowRadius + kPatchRadius + kPoolRadius;

// A finite pixel, in units of about the picture's mean radiance.
struct NoisyPixel {
    vec3 mean;
    vec3 variance;  // of the mean
};

struct WeightedSum {
    vec3 radiance;
    float weight;
};

// Push constants: threads [first, first + count) of a band of `height` rows. Pixels are compared with those of one row of their windows,
// 0 being the uppermost.
struct DenoisePass {
    uint width, height;
    uint first, count;
    uint windowRow;
};

GLIM_SHARED_END
#endif
