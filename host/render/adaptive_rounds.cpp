// The rounds of --adaptive neighbours, and the control that measures its bias.
#include "host/render/allocate_samples.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace glim {
namespace {

// Mean samples per pixel after a round that begins with `samples`: 64, 96, 128, 192, 256, 384 ... A round grows by half at most, since
// later plans rest on better estimates. Powers of two are included for those who compare there.
std::uint32_t usualRoundEnd(std::uint32_t samples)
{
    if (samples == 0) {
        return kPilotSamples;
    }
    const std::uint32_t power = std::bit_floor(samples), middle = power + power / 2;
    return samples < middle ? middle : 2 * power;
}

}  // namespace

// All pixels get the same half of a round's samples, down to whole blocks but at least kPilotSamples. These alone decide who gets the
// other half. If there is a target, the round goes no further than it is expected to need.
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
    for (const auto& tile : tiles_) {
        tile->chooseAll();
    }
    tile_ = 0;
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
    foldPages(film_, tiles_);
    foldSplats(film_);
    foldVersion_ = nextFoldVersion();
    choosing_ = false;
    sweeping_ = false;
    mean_ = roundEnd_;
}

// Folds the samples of a round that all pixels share.
void Renderer::foldCommon()
{
    for (const auto& tile : tiles_) {
        wavefront_->closeBlocks(*tile);
        const std::vector<PixelMoments> pages = tile->takePages();
        foldPage(film_, tile->begin(), pages);
        foldPage(common_, tile->begin(), pages);
    }
    foldSplats(film_);
    common_.splats = film_.splats;
    foldVersion_ = nextFoldVersion();
}

std::optional<Film> Renderer::sampleControl(const Film& film, const std::function<bool()>& shouldContinue)
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
            going = runPass(nextPass(0, sweep_.sampleCount), shouldContinue);
        } while (going && findTile());
    }
    statistics_ = before;
    if (!going) {
        return std::nullopt;
    }
    Film control;
    control.pixels.resize(film.pixels.size());
    foldPages(control, tiles_);
    return control;
}

// Starts the next sweep over `blocks`; false if none are left.
bool Renderer::chooseSweep(BlockQueue& blocks)
{
    auto sweep = blocks.take(passSize_.paths());
    if (!sweep) {
        return false;
    }
    sweep_ = *std::move(sweep);
    auto from = sweep_.pixels.begin();
    for (const auto& tile : tiles_) {
        std::vector<ChosenPixel> chosen;
        for (; from != sweep_.pixels.end() && from->pixel < tile->begin() + tile->count(); ++from) {
            chosen.push_back({from->pixel - tile->begin(), from->sample});
        }
        tile->choose(chosen);
    }
    tile_ = 0;
    pixel_ = 0;
    return findTile();
}

}  // namespace glim
