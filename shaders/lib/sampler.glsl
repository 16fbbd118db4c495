// Random numbers of a path: a pure function of (seed, pixel, sample, dimension).
#ifndef GLIM_LIB_SAMPLER
#define GLIM_LIB_SAMPLER

#include "hash.glsl"
#include "shared/limits.h"
#include "sobol.glsl"

// Dimensions, each a pair of numbers. Those of bounce b begin at kDimensionBounce + b * kDimensionsPerBounce.
const uint kDimensionPixel = 0u;
const uint kDimensionLens = 0xffffffffu;
const uint kDimensionTime = 0xfffffffeu;  // the first number alone
const uint kDimensionBounce = 1u;
const uint kDimensionLight = 0u;  // which light
const uint kDimensionPoint = 1u;  // where on it
const uint kDimensionBsdf = 2u;   // direction of the next ray
const uint kDimensionLobe = 3u;   // which lobe; the second number is roulette's
const uint kDimensionsPerBounce = 4u;
// Whether a surface that is transparent in places is met, apart from all these: with the bounce in the lower bits.
const uint kDimensionAlpha = 0x40000000u;
const uint kDimensionWavelength = 0x20000000u;
// Of rays within media that scatter, with the bounce in the lower bits.
const uint kDimensionFreePath = 0x08000000u;
const uint kDimensionDeflection = 0x04000000u;

// Of light paths: which light and target, where on the light, the direction; then kDimensionsPerBounce for each surface.
const uint kDimensionEmitter = 0u;
const uint kDimensionEmission = 1u;
const uint kDimensionAim = 2u;
const uint kDimensionLightBounce = 3u;
// Where a light path's vertex sees the camera's lens, apart from all these, plus the bounce.
const uint kDimensionCameraLens = 0x10000000u;

// Bounces with Sobol' points; beyond them paths are too blurred to gain, and independent numbers are cheaper.
const uint kSobolBounces = 4u;

struct SampleId {
    uint seed;
    uint pixel;
    uint index;  // absolute sample index
};

uint bounceDimension(uint bounce, uint dimension)
{
    return kDimensionBounce + bounce * kDimensionsPerBounce + dimension;
}

uvec2 independentPair(SampleId id, uint dimension)
{
    return hash4(uvec4(id.pixel, id.index, dimension, id.seed)).xy;
}

// Each block has a scramble of its own, so that block means are independent and give the variance.
uvec2 sobolPair(SampleId id, uint dimension)
{
    uint point = id.index % blockSamples(id.index), block = (id.index - point) / kFirstBlockSamples;
    // The uppermost bit keeps this counter distinct from independentPair's.
    uvec4 seeds = hash4(uvec4(id.pixel, block | 0x80000000u, dimension, id.seed));
    return scrambledSobolPoint(point, seeds.xyz);
}

uvec2 samplePair(SampleId id, uint dimension, bool sobol)
{
    bool early = dimension < bounceDimension(kSobolBounces, 0u) || dimension >= kDimensionTime;
    return sobol && early ? sobolPair(id, dimension) : independentPair(id, dimension);
}

// Light path number `path` of one sample of the picture. Its numbers are apart from those of any pixel's paths.
SampleId lightPathId(uint seed, uint path, uint sampleIndex)
{
    return SampleId(hash4(uvec4(seed, 0x6c696768u, 0x74u, 0u)).x, path, sampleIndex);
}

// One sequence of points for all light paths of a block, `paths` for each of its samples.
uvec2 lightPathPair(SampleId id, uint paths, uint dimension, bool sobol)
{
    if (!sobol) {
        return independentPair(id, dimension);
    }
    uint inBlock = id.index % blockSamples(id.index), block = (id.index - inBlock) / kFirstBlockSamples;
    uvec4 seeds = hash4(uvec4(0xffffffffu, block | 0x80000000u, dimension, id.seed));
    return scrambledSobolPoint(inBlock * paths + id.pixel, seeds.xyz);
}

#endif
