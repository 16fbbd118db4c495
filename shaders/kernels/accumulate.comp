// One thread is one pixel of the pass. Adds its finished samples to the block, in the order of their index, and folds each block into the
// page when the block ends. So the bits do not depend on how the samples were divided into passes. Adds nothing while a path is alive, of
// this pass or left by the one before.
// Reads radiance, light of groups, first hits, rounds. Updates blocks, pages and, in renders that ask for them, brightest samples; counts samples that are
// not finite and leaves them out. May say that paths are left.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RADIANCE
#define READS_GROUP_LIGHT
#define READS_FIRST_HITS
#define UPDATES_ROUNDS
#define UPDATES_FILM
#include "access/group_sums.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/finite.glsl"
#include "shared/luminance.h"
#include "lib/moments.glsl"
#include "lib/sampler.glsl"

float coverageOf(FirstHit first)
{
    return hasFeature(kFeatureCatcher) ? abs(first.alpha) : first.alpha;
}

BlockSums addSample(BlockSums sums, PathRadiance path, FirstHit first)
{
    return BlockSums(sums.count + 1u, sums.radiance + path.radiance, sums.alpha + coverageOf(first), sums.albedo + first.albedo,
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
struct PassPixel {
    uint pixel, at, firstSample;
};

PassPixel passPixel(uint pixel)
{
    bool every = (pass.accumulate & kEveryPixel) != 0u;
    return PassPixel(pixel, every ? pixel : getPassPixel(pixel), every ? pass.firstSample : getFirstSample(pixel));
}

BlockSums addFinished(PassPixel from, uint i, BlockSums sums, inout CatcherSums caught)
{
    uint slot = from.pixel * pass.sampleCount + i;
    PathRadiance path = fetchRadiance(slot);
    PathRadiance without = PathRadiance(vec3(0.0), 0.0);
    if (hasFeature(kFeatureCatcher)) {
        without = fetchRadiance(slot + samplesOfPass());
    }
    if (!isFinite(path.radiance) || !isFinite(without.radiance)) {
        reportNonFinite(pass.tileBegin + from.at, from.firstSample + i);
        return sums;
    }
    FirstHit first = fetchFirstHit(slot);
    if (hasFeature(kFeatureCatcher) && first.alpha < 0.0) {
        caught = CatcherSums(caught.share + 1.0, caught.with + path.radiance, caught.without + without.radiance, caught.page);
    }
    if (hasFeature(kFeatureLightGroups)) {
        addGroups(from.at, slot);
    }
    if (kSuspects) {
        keepBrightest(from.at, computeLuminance(path.radiance), from.firstSample + i);
    }
    return addSample(sums, path, first);
}

// Whether a block ends with the pass's sample i.
bool endsBlock(PassPixel from, uint i)
{
    uint sampleIndex = from.firstSample + i;
    return (sampleIndex + 1u) % blockSamples(sampleIndex) == 0u;
}

void addPixel(PassPixel from)
{
    BlockSums sums = filmBlocks[from.at];
    if (sums.count == 0u) {
        sums = emptyBlock();  // the host fills new blocks with zeros
    }
    CatcherSums caught;
    if (hasFeature(kFeatureCatcher)) {
        caught = filmCatchers[from.at];
    }
    // One iteration more than there are samples, for the block that ends with the pass. So the code that folds into the page exists once;
    // CPU drivers compile a load and a store for each of its words, at some 10 ms each.
    for (uint i = 0u; i <= pass.sampleCount; ++i) {
        bool ends = (pass.accumulate & kEndsBlock) != 0u;
        if (i < pass.sampleCount) {
            sums = addFinished(from, i, sums, caught);
            ends = endsBlock(from, i);
        }
        if (ends) {
            if (hasFeature(kFeatureCatcher)) {
                caught = foldCatcher(caught, sums.count);
            }
            if (hasFeature(kFeatureLightGroups)) {
                foldGroups(from.at, filmPages[from.at].count, sums.count);
            }
            filmPages[from.at] = foldMoments(filmPages[from.at], computeBlockMoments(sums));
            sums = emptyBlock();
        }
    }
    filmBlocks[from.at] = sums;
    if (hasFeature(kFeatureCatcher)) {
        filmCatchers[from.at] = caught;
    }
}

void main()
{
    uint pixel = interleavedInvocation();
    uint alive = activePaths();
    if (alive > 0u) {
        if (pixel == 0u && (pass.accumulate & kStopsNext) != 0u) {
            rounds[kLeftRound].paths.count = alive;
        }
    } else if (pixel < pass.pixelCount && rounds[kLeftRound].paths.count == 0u) {
        addPixel(passPixel(pixel));
    }
    checkLoopBudget(render.canarySteps);
}
