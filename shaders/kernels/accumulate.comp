// One thread is one pixel of the pass. Adds its finished samples to the block, in the order of their index, and folds each block
// into the page when it ends: the bits do not depend on how the work was cut.
// Reads radiance and first hits. Updates blocks, pages and, in renders that ask for them, brightest samples; counts samples that are not
// finite and leaves them out.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RADIANCE
#define READS_FIRST_HITS
#define UPDATES_FILM
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/finite.glsl"
#include "lib/luminance.glsl"
#include "lib/moments.glsl"
#include "lib/sampler.glsl"

BlockSums addSample(BlockSums sums, PathRadiance path, FirstHit first)
{
    return BlockSums(sums.count + 1u, sums.radiance + path.radiance, sums.alpha + first.alpha, sums.albedo + first.albedo,
                     sums.normal + first.normal, min(sums.depth, first.depth), sums.clamped + path.clamped);
}

// Samples come in the order of their index: ties go to the lower one.
void keepBrightest(uint at, float luminance, uint sampleIndex)
{
    if (luminance > filmBrightest[at].luminance) {
        filmBrightest[at] = BrightestSample(luminance, sampleIndex);
    }
}

// What one thread adds: which pixel's samples to which place of the film.
struct Target {
    uint pixel, at, firstSample;
};

Target targetOf(uint pixel)
{
    bool every = (pass.accumulate & kEveryPixel) != 0u;
    return Target(pixel, every ? pixel : pixelOfPass(pixel), every ? pass.firstSample : firstSampleOfPass(pixel));
}

BlockSums addFinished(Target target, uint i, BlockSums sums)
{
    uint slot = target.pixel * pass.sampleCount + i;
    PathRadiance path = fetchRadiance(slot);
    if (!isFinite(path.radiance)) {
        reportNonFinite(pass.tileBegin + target.at, target.firstSample + i);
        return sums;
    }
    FirstHit first = fetchFirstHit(slot);
    if (kSuspects) {
        keepBrightest(target.at, luminanceOf(path.radiance), target.firstSample + i);
    }
    return addSample(sums, path, first);
}

// Whether a block ends with the pass's sample i.
bool endsBlock(Target target, uint i)
{
    uint sampleIndex = target.firstSample + i;
    return (sampleIndex + 1u) % blockSamples(sampleIndex) == 0u;
}

void addPixel(Target target)
{
    BlockSums sums = filmBlocks[target.at];
    if (sums.count == 0u) {
        sums = emptyBlock();  // the host fills new blocks with zeros
    }
    // One iteration more than there are samples, for the block that ends with the pass. So the code that folds into the page exists once;
    // llvmpipe compiles a load and a store for each of its words, at some 10 ms each.
    for (uint i = 0u; i <= pass.sampleCount; ++i) {
        bool ends = (pass.accumulate & kEndsBlock) != 0u;
        if (i < pass.sampleCount) {
            sums = addFinished(target, i, sums);
            ends = endsBlock(target, i);
        }
        if (ends) {
            filmPages[target.at] = foldMoments(filmPages[target.at], momentsOfBlock(sums));
            sums = emptyBlock();
        }
    }
    filmBlocks[target.at] = sums;
}

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount) {
        addPixel(targetOf(pixel));
    }
    checkLoopBudget(render.canarySteps);
}
