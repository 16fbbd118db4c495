// Which samples of which pixels come next. A sweep goes over all pixels, or over those that an adaptive render has chosen, for the
// same number of samples. --adaptive neighbours goes in rounds: sweeps over all pixels, then some over chosen ones, which take blocks
// of samples beyond those that all pixels will ever have.
#include "host/render/allocate_samples.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace glim {
namespace {

// Mean samples after a round that begins with `samples` of them: 64, 96, 128, 192, 256, 384 ... A round grows by half at most, since
// what it is planned from is worth more later, and powers of two are met for who looks there.
std::uint32_t usualRoundEnd(std::uint32_t samples)
{
    if (samples == 0) {
        return kPilotSamples;
    }
    const std::uint32_t power = std::bit_floor(samples), middle = power + power / 2;
    return samples < middle ? middle : 2 * power;
}

}  // namespace

// End of the sweep under way: the first samples are swept 1, 1, 2, 4, 8, 16 and 32 at a time, so that a render that is stopped
// early covers its picture evenly; later blocks at once, which keeps the rays of a pixel together.
std::uint32_t Renderer::sweepEnd() const
{
    const std::uint32_t done = sample_ - settings_.sampleBegin;
    const std::uint32_t last = isNeighbours(settings_.adaptive) ? commonEnd_ : settings_.sampleEnd;
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t end = std::min({last, (sample_ / kBlockSamples + 1) * kBlockSamples, sample_ + count});
    return isCourse(settings_.adaptive) ? std::min(end, (sample_ / settings_.batch + 1) * settings_.batch) : end;
}

bool Renderer::advance(const std::function<bool()>& goesOn)
{
    while (isNeighbours(settings_.adaptive) && isBetweenRounds() && !isDone()) {
        startRound();
    }
    if (isDone()) {
        return false;
    }
    // Chosen pixels of a round have first samples of their own.
    const Pass pass = choosing_ ? nextPass(0, sweepSamples_) : nextPass(sample_, sweepEnd() - sample_);
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
    if (choosing_) {
        if (!chooseSweep(chosenBlocks_)) {
            endRound();
        }
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
    if (isNeighbours(settings_.adaptive)) {
        if (sample_ == commonEnd_) {
            foldCommon();
            startChoosing();
        }
    } else if (sample_ % kPageSamples == 0) {
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

// Half of a round's samples, down to whole blocks, but at least kPilotSamples, are the same for all pixels, and they alone say who gets the others. With a
// target in sight the round goes no further than that.
void Renderer::startRound()
{
    const auto most = static_cast<double>(std::min(usualRoundEnd(mean_), settings_.sampleEnd));
    const double wanted = mean_ == 0 ? most : mean_ * std::max(1.12, 1.02 * timesToTarget_);
    roundEnd_ = static_cast<std::uint32_t>(std::ceil(std::min(most, wanted)));
    commonEnd_ = std::max(std::min(kPilotSamples, roundEnd_), roundEnd_ / 2 / kBlockSamples * kBlockSamples);
    if (sample_ == commonEnd_) {
        startChoosing();
        return;
    }
    for (const auto& slab : slabs_) {
        slab->chooseAll();
    }
    slab_ = 0;
    pixel_ = 0;
}

void Renderer::startChoosing()
{
    const SquaredError error = settings_.adaptive == Adaptive::Neighbours ? SquaredError::Relative : SquaredError::Absolute;
    if (roundEnd_ > commonEnd_) {
        chosenBlocks_.add(allocateBlocks(computeShares(common_, error), chosenBlocks_.samples(), roundEnd_ - commonEnd_));
    }
    choosing_ = chooseSweep(chosenBlocks_);
    if (!choosing_) {
        endRound();
    }
}

void Renderer::endRound()
{
    foldPages(film_, slabs_);
    foldVersion_ = nextFoldVersion();
    choosing_ = false;
    sweeping_ = false;
    mean_ = roundEnd_;
}

// The common samples of a round.
void Renderer::foldCommon()
{
    for (const auto& slab : slabs_) {
        wavefront_->closeBlocks(*slab);
        const std::vector<PixelMoments> pages = slab->takePages();
        foldPage(film_, slab->begin(), pages);
        foldPage(common_, slab->begin(), pages);
    }
    foldVersion_ = nextFoldVersion();
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
    bool going = true;
    while (going && chooseSweep(blocks)) {
        do {
            going = runPass(nextPass(0, sweepSamples_), goesOn);
        } while (going && findSlab());
    }
    statistics_ = before;
    if (!going) {
        return std::nullopt;
    }
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
