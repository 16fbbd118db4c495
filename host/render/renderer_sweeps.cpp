// Which samples of which pixels come next. A sweep goes over all pixels, or over those that an adaptive render has chosen, for the
// same number of samples. --adaptive neighbours begins with kPilotSamples everywhere; each round after that is several sweeps, in
// which pixels get different numbers of blocks.
#include "host/render/allocate_samples.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace glim {
namespace {

// Mean samples after a round that begins with `samples` of them: 96, 128, 192, 256, 384 ... A round grows by half at most, since
// what it is planned from is worth more later, and powers of two are met for who looks there.
std::uint32_t usualRoundEnd(std::uint32_t samples)
{
    const std::uint32_t power = std::bit_floor(samples), middle = power + power / 2;
    return samples < middle ? middle : 2 * power;
}

}  // namespace

bool Renderer::isInRounds() const { return isNeighbours(settings_.adaptive) && sample_ >= kPilotSamples; }

// End of the sweep under way: the first block is swept 1, 1, 2, 4, 8 and 16 samples at a time, so that a render that is stopped
// early covers its picture evenly; later blocks at once, which keeps the rays of a pixel together. Of a round its mean.
std::uint32_t Renderer::sweepEnd() const
{
    if (isInRounds()) {
        return roundEnd_;
    }
    const std::uint32_t done = sampleCount();
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t end = std::min({settings_.sampleEnd, (sample_ / kBlockSamples + 1) * kBlockSamples, sample_ + count});
    return isCourse(settings_.adaptive) ? std::min(end, (sample_ / settings_.batch + 1) * settings_.batch) : end;
}

bool Renderer::advance(const std::function<bool()>& goesOn)
{
    while (isInRounds() && roundEnd_ <= sample_ && !isDone()) {
        startRound();
    }
    if (isDone()) {
        return false;
    }
    // In rounds each pixel has a first sample of its own.
    const Pass pass = isInRounds() ? nextPass(0, sweepSamples_) : nextPass(sample_, sweepEnd() - sample_);
    if (!runPass(pass, goesOn)) {
        return false;
    }
    if (!findSlab()) {
        endSweep();
    }
    return true;
}

// The slab that has the sweep's next pixel; false if there is none.
bool Renderer::findSlab()
{
    while (slab_ < slabs_.size() && pixel_ == slabs_[slab_]->chosenCount()) {
        ++slab_;
        pixel_ = 0;
    }
    return slab_ < slabs_.size();
}

Pass Renderer::nextPass(std::uint32_t firstSample, std::uint32_t sampleCount) const
{
    const Slab& slab = *slabs_[slab_];
    Pass pass = wavefront_->passOf(slab);
    pass.firstPixel = pixel_;
    pass.firstSample = firstSample;
    pass.sampleCount = sampleCount;
    pass.pixelCount = std::min(slab.chosenCount() - pixel_, std::max(1U, passSize_.paths() / pass.sampleCount));
    return pass;
}

void Renderer::endSweep()
{
    if (isInRounds() && chooseSweep(blocks_)) {
        return;
    }
    sample_ = sweepEnd();
    sweeping_ = false;
    if (isCourse(settings_.adaptive) && sample_ % settings_.batch == 0) {
        chosen_ = choosePixels();
        plannedSamples_ = pictureSamples_ + chosen_ * (settings_.sampleEnd - sample_);
    }
    slab_ = 0;
    findSlab();
    // Pixels of rounds have no pages in common: theirs has no end.
    if (sample_ % kPageSamples == 0 && !isNeighbours(settings_.adaptive)) {
        foldPages(film_, slabs_);
        foldVersion_ = nextFoldVersion();
    }
}

// How many pixels still need samples.
std::uint64_t Renderer::choosePixels()
{
    std::uint64_t chosen = 0;
    for (const auto& slab : slabs_) {
        wavefront_->choosePixels(*slab);
        chosen += slab->chosenCount();
    }
    return chosen;
}

// With a target in sight no further than that.
void Renderer::startRound()
{
    const auto most = static_cast<double>(std::min(usualRoundEnd(sample_), settings_.sampleEnd));
    const double wanted = sample_ * std::max(1.12, 1.02 * timesToTarget_);
    roundEnd_ = static_cast<std::uint32_t>(std::ceil(std::min(most, wanted)));
    if (sample_ == kPilotSamples) {
        blocks_ = BlockQueue(film_.pixels.size(), kPilotSamples);
    }
    const SquaredError error = settings_.adaptive == Adaptive::Neighbours ? SquaredError::Relative : SquaredError::Absolute;
    blocks_.add(allocateBlocks(computeShares(film(), error), blocks_.next(), roundEnd_));
    if (!chooseSweep(blocks_)) {
        sample_ = roundEnd_;  // it was less than half a block
    }
}

std::optional<Film> Renderer::sampleControl(const Film& film, const std::function<bool()>& goesOn)
{
    const double share = std::max(0.01, 64.0 / static_cast<double>(film.pixels.size()));
    std::vector<std::uint32_t> needed(film.pixels.size(), 0);
    std::mt19937 random(settings_.seed);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        const bool isControl = static_cast<double>(random()) < share * 0x1p32;
        needed[i] = isControl ? (film.pixels[i].count + kBlockSamples - 1) / kBlockSamples : 0;
    }
    const std::uint32_t begin = (film.sampleRanges.back().second + kBlockSamples - 1) / kBlockSamples * kBlockSamples;
    BlockQueue blocks(film.pixels.size(), begin);
    blocks.add(needed);
    const RenderStatistics before = statistics_;
    while (chooseSweep(blocks)) {
        do {
            if (!runPass(nextPass(0, sweepSamples_), goesOn)) {
                return std::nullopt;
            }
        } while (findSlab());
    }
    statistics_ = before;
    Film control;
    control.pixels.resize(film.pixels.size());
    foldPages(control, slabs_);
    return control;
}

// False if there is none left.
bool Renderer::chooseSweep(BlockQueue& blocks)
{
    const auto sweep = blocks.take(passSize_.paths());
    if (!sweep) {
        return false;
    }
    sweepSamples_ = sweep->sampleCount;
    auto from = sweep->pixels.begin();
    for (const auto& slab : slabs_) {
        std::vector<ChosenPixel> chosen;
        for (; from != sweep->pixels.end() && from->pixel < slab->begin() + slab->count(); ++from) {
            chosen.push_back({from->pixel - slab->begin(), from->sample});
        }
        slab->choose(chosen);
    }
    slab_ = 0;
    pixel_ = 0;
    return findSlab();
}

}  // namespace glim
