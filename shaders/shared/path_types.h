// What kernels hand to each other. Arrays are indexed by slot: the place of a path in the pass. Up to ShadowRay they are whole texels,
// as which kernels read them (paths.glsl).
#ifndef GLIM_SHARED_PATH_TYPES_H
#define GLIM_SHARED_PATH_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

struct PathRay {
    vec3 origin;
    uint source;     // primitive that the ray leaves, or kNoPrimitive
    vec3 direction;  // unit
    uint unused;
};

struct PathHit {
    uint record;       // kNoRecord: a miss
    float t;
    vec2 barycentric;  // weights of v1 and v2; a sphere's are unused
};

struct PathState {
    vec3 throughput;
    float pdf;       // of the ray's direction per steradian; 0: camera, mirror or glass, which light sampling cannot find
    float cosine;    // of the ray's direction against the shading normal it left, >= 0
    float etaScale;  // product of squared relative indices: throughput * etaScale is free of the glass's compression
    uint bounce;     // surfaces met
    uint unused;
};

struct PathRadiance {
    vec3 radiance;
    float clamped;   // mean of the three channels of what --clamp-indirect took away
};

struct FirstHit {
    vec3 albedo;
    float alpha;
    vec3 normal;
    float depth;
};

// A segment that must be free for `contribution` to count: from origin to origin + direction. Over the hemisphere instead, a ray
// without end that brings home the emission of what it meets times `contribution`.
struct ShadowRay {
    vec3 origin;
    uint source;
    vec3 direction;  // unnormalised; an infinite one for directional light and environment (see `reach`)
    uint target;     // primitive of the light, which does not shadow itself, or kNoPrimitive; over the hemisphere, brute force
                     // notes the record that was met so far, or kNoRecord
    vec3 contribution;
    float reach;     // 1, or infinity; brute force sets it to 0 in the shadow and, over the hemisphere, to the nearest hit's t
};

GLIM_CONST uint kNothing = 0xffffffffu;

// What happened to a path where it met a surface and no other buffer tells. Lengths and directions as in PathRay, pdfs per
// steradian.
struct PathNote {
    vec3 point;
    vec3 geometric;    // unit normals on the side that the path came from
    vec3 shading;
    uint front;        // 1: that is the front
    float foundPdf;    // with which sampling lights would have found the light that the path has found; 0: it was not asked
    float foundWeight; // of that light; 1 unless noted
    uint light;        // that was sampled, or kNothing
    float lightPdf;    // of choosing that light and that direction; 0: a point, spot or directional light
    float scatterPdf;  // with which scattering would have found it
    float lightWeight;
    vec3 weight;       // of the scattering: function * cosine / pdf
    vec3 throughput;   // with that weight, before roulette
    float survival;    // of roulette; 0: the path did not get there
};

// Written by size_dispatch: the length of each queue and the indirect arguments of the dispatches over it.
struct QueueSizes {
    uint closest;
    uint shadow;
    uvec3 closestGroups;
    uvec3 shadowGroups;
};

// Where the next entry goes.
struct QueueTails {
    uint next;
    uint shadow;
};

// Rays traced so far in this render, 64 bits in two words.
struct RayCounts {
    uvec2 closest;
    uvec2 shadow;
};

GLIM_CONST uint kMaxLocated = 16u;

struct Located {
    uint pixel;   // index in the picture
    uint sampleIndex;
};

struct Status {
    uint loopCaps;                 // threads whose driver stops loops early: the picture is wrong
    uint overflows;                // entries of queues beyond one per slot: the picture is wrong
    uint nonFinite;                // samples that were not finite, and are in no average
    Located located[kMaxLocated];  // the first of them to be counted
};

// Sums over the samples of a block so far.
struct BlockSums {
    uint count;
    vec3 radiance;
    float alpha;
    vec3 albedo;
    vec3 normal;
    float depth;  // the nearest
    float clamped;
};

GLIM_CONST uint kEndsBlock = 1u;   // accumulate folds the block into the page afterwards, whole or not
GLIM_CONST uint kEveryPixel = 2u;  // the pass goes over all pixels of the slab, whichever are chosen

// Of a pass over some pixels of a slab, which need not have had the same number of samples before.
struct ChosenPixel {
    uint pixel;          // index in the slab
    uint samplesBefore;  // is added to the pass's firstSample
};

// Which queues size_dispatch looks at.
GLIM_CONST uint kSizesPaths = 1u;
GLIM_CONST uint kSizesShadow = 2u;
GLIM_CONST uint kSizesShares = 4u;  // the paths, for trace_paths, which counts its rays itself

// Lights of a round that are none of the scene's.
GLIM_CONST uint kNoLightIndex = 0xffffffffu;
GLIM_CONST uint kAnyLight = 0xfffffffeu;  // one by power

// Push constants of every kernel of a pass: pixels [firstPixel, firstPixel + pixelCount) of a slab or, in adaptive renders, of
// its list of chosen pixels, each with samples [firstSample, firstSample + sampleCount); a chosen pixel may begin later.
// Slot = (pixel - firstPixel) * sampleCount + (sample - firstSample).
//
// Direct light comes in rounds of one ray per path: sample `lightSample` of `lightSamples` of one light or of the hemisphere.
struct Pass {
    uint width, height;
    uint slabBegin;     // index in the picture of the slab's pixel 0
    uint firstPixel;    // within the slab
    uint pixelCount;
    uint firstSample;
    uint sampleCount;
    uint seed;
    uint bounce;        // surface events before the hit at hand
    uint maxBounces;
    uint lightCount;
    uint environmentLight;  // index, if the scene has an environment
    vec3 environment;
    float clampIndirect;    // infinity: off
    uint accumulate;        // kEndsBlock | kEveryPixel
    uint canarySteps;       // 3, unknown to the compiler
    uint leastEvents;       // surfaces between camera and light, of the light that counts
    uint mostEvents;
    float survival;         // of kRouletteFixed
    uint sizes;             // kSizesPaths | kSizesShadow, or kSizesShares
    uint addsFound;         // 1: sample_lights adds the light that the ray itself has found (the first round)
    uint light;             // of the round: an index, kAnyLight or kNoLightIndex
    uint lightSample;
    uint lightSamples;
    uint firstRecord;       // of brute force: records [firstRecord, endRecord) out of recordCount
    uint endRecord;
    uint recordCount;
    float tolerance;        // of choose_pixels: half the 95 % interval over the mean
    uint constantSamples;   // a pixel whose samples are all equal needs as many
};

GLIM_SHARED_END
#endif
