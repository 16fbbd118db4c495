// What the denoiser's kernels read.
#ifndef GLIM_SHARED_DENOISE_TYPES_H
#define GLIM_SHARED_DENOISE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Radii of squares around a pixel, in pixels. Larger windows and patches were no better on six scenes (tests/denoising.md).
GLIM_CONST int kPoolRadius = 2;    // over which the variance is averaged
GLIM_CONST int kPatchRadius = 2;   // that is compared
GLIM_CONST int kWindowRadius = 5;  // whose pixels are averaged

// The rows above and below that the result of a row depends on.
GLIM_CONST int kDenoiseMargin = kWindowRadius + kPatchRadius + kPoolRadius;

// A finite pixel, in units of about the picture's mean radiance.
struct NoisyPixel {
    vec3 mean;
    vec3 variance;  // of the mean
};

// Push constants: pixels [firstPixel, firstPixel + pixelCount) of a band of `height` rows.
struct DenoisePass {
    uint width, height;
    uint firstPixel, pixelCount;
};

GLIM_SHARED_END
#endif
