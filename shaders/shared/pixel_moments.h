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

// What a pixel shows of shadow catchers: light of samples that met one first, over all samples, with the objects and without them.
struct CatcherMoments {
    uint count;   // samples
    float share;  // of them met a catcher first
    vec3 with, without;
    vec3 squares;  // as in PixelMoments: of the luminance with, without, and of their difference
};

// In float32 on the host too.
GLIM_FUNCTION float luminanceOfMoments(vec3 c) { return (c.x * 0.2126f + c.y * 0.7152f) + c.z * 0.0722f; }

GLIM_FUNCTION CatcherMoments foldMoments(CatcherMoments a, CatcherMoments b)
{
    if (a.count == 0u) {
        return b;
    }
    if (b.count == 0u) {
        return a;
    }
    CatcherMoments sum = a;
    sum.count = a.count + b.count;
    float share = float(b.count) / float(sum.count);
    vec3 with = b.with - a.with;
    vec3 without = b.without - a.without;
    vec3 delta = vec3(luminanceOfMoments(with), luminanceOfMoments(without), luminanceOfMoments(without - with));
    sum.share = a.share + (b.share - a.share) * share;
    sum.with = a.with + with * share;
    sum.without = a.without + without * share;
    sum.squares = (a.squares + b.squares) + (delta * delta) * (float(a.count) * share);
    return sum;
}

// By light groups a pixel has the mean of each group and then, for each pair of them (0, 0), (0, 1) ... (1, 1) ..., what `squares` is in
// PixelMoments, with the one's mean times the other's.
GLIM_FUNCTION uint pairsOfGroups(uint groups) { return groups * (groups + 1u) / 2u; }
GLIM_FUNCTION uint momentsOfGroups(uint groups) { return groups + pairsOfGroups(groups); }
// On the device the sums of the open block come first, one for each group.
GLIM_FUNCTION uint sumsOfGroups(uint groups) { return groups + momentsOfGroups(groups); }

// As foldMoments: what b's mean is apart from a's is `delta`; samplesOfA of samplesOfA + b's are a's, and share of them b's.
GLIM_FUNCTION vec3 foldMean(vec3 a, vec3 delta, float share) { return a + delta * share; }
GLIM_FUNCTION vec3 foldProducts(vec3 a, vec3 b, vec3 delta, vec3 otherDelta, float samplesOfA, float share)
{
    return (a + b) + (delta * otherDelta) * (samplesOfA * share);
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
