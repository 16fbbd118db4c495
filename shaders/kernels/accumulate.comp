// One thread is one pixel of the pass. Adds its finished samples to the block, in the order of their index, and folds each block
// into the page when it ends: the bits do not depend on how the work was cut.
// Reads radiance and first hits. Updates blocks, pages and, in renders that ask for them, luminance and brightest samples; counts
// samples that are not finite and leaves them out.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RADIANCE
#define READS_FIRST_HITS
#define UPDATES_FILM
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/moments.glsl"
#include "lib/sampler.glsl"
#include "lib/stop_rule.glsl"

bool isFinite(float x)
{
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

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

BlockSums endBlock(uint at, BlockSums sums)
{
    filmPages[at] = foldMoments(filmPages[at], momentsOfBlock(sums));
    return emptyBlock();
}

void addPixel(uint pixel)
{
    bool every = (pass.accumulate & kEveryPixel) != 0u;
    uint at = every ? pixel : pixelOfPass(pixel);
    uint firstSample = every ? pass.firstSample : firstSampleOfPass(pixel);
    BlockSums sums = filmBlocks[at];
    if (sums.count == 0u) {
        sums = emptyBlock();  // the host fills new blocks with zeros
    }
    for (uint i = 0u; i < pass.sampleCount; ++i) {
        uint slot = pixel * pass.sampleCount + i;
        PathRadiance path = fetchRadiance(slot);
        if (isFinite(path.radiance.r) && isFinite(path.radiance.g) && isFinite(path.radiance.b)) {
            FirstHit first = fetchFirstHit(slot);
            sums = addSample(sums, path, first);
            if (kSuspects) {
                keepBrightest(at, luminanceOf(path.radiance), firstSample + i);
            }
            if (kLuminance) {
                filmLuminance[at] = addLuminance(filmLuminance[at], luminanceOf(path.radiance), first.alpha > 0.0);
            }
        } else {
            reportNonFinite(pass.slabBegin + at, firstSample + i);
        }
        if ((firstSample + i + 1u) % blockSamples(firstSample + i) == 0u) {
            sums = endBlock(at, sums);
        }
    }
    if ((pass.accumulate & kEndsBlock) != 0u) {
        sums = endBlock(at, sums);
    }
    filmBlocks[at] = sums;
}

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount) {
        addPixel(pixel);
    }
    checkLoopBudget(pass.canarySteps);
}
