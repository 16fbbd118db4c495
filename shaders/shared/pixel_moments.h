// What is known of a pixel: the mean of its samples and the spread of its block means.
#ifndef GLIM_SHARED_PIXEL_MOMENTS_H
#define GLIM_SHARED_PIXEL_MOMENTS_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

struct PixelMoments {
    uint count;     // samples averaged; non-finite ones are not among them
    uint blocks;    // blocks with at least one sample
    vec3 mean;      // radiance, W/(sr m^2)
    vec3 squares;   // sum over blocks of (samples in block) * (block mean - mean)^2
    float alpha;    // share of samples whose camera ray met a surface
    vec3 albedo;    // mean base colour at the camera ray's hit; 0 on a miss
    vec3 normal;    // mean shading normal, world axes, towards the camera; 0 on a miss
    float depth;    // nearest camera hit, metres along the view axis; infinity if all missed
    float clamped;  // radiance taken away by --clamp-indirect, mean of the three channels
};

// Chan, Golub, LeVeque, "Algorithms for Computing the Sample Variance", 1983. The device folds blocks into pages, the
// host pages into films. Exactly this order of float32 operations makes a merged film equal to the single run bit for bit.
GLIM_FUNCTION PixelMoments foldMoments(PixelMoments a, PixelMoments b)
{
    if (a.count == 0u) {
        return b;
    }
    if (b.count == 0u) {
        return a;
    }
    PixelMoments sum = a;
    sum.count = a.count + b.count;
    sum.blocks = a.blocks + b.blocks;
    float share = float(b.count) / float(sum.count);
    vec3 delta = b.mean - a.mean;
    sum.mean = a.mean + delta * share;
    sum.squares = (a.squares + b.squares) + (delta * delta) * (float(a.count) * share);
    sum.alpha = a.alpha + (b.alpha - a.alpha) * share;
    sum.albedo = a.albedo + (b.albedo - a.albedo) * share;
    sum.normal = a.normal + (b.normal - a.normal) * share;
    sum.depth = min(a.depth, b.depth);
    sum.clamped = a.clamped + (b.clamped - a.clamped) * share;
    return sum;
}

// Luminance (Rec.709) of a pixel's samples, for adaptive sampling.
struct LuminanceMoments {
    uint count;
    float mean;
    float squares;  // sum of (luminance - mean)^2
    uint met;       // samples whose camera ray met a surface
};

// A pixel's brightest sample, the first of equals; 0 and 0 while all are black.
struct BrightestSample {
    float luminance;
    uint sampleIndex;
};

GLIM_SHARED_END
#endif
