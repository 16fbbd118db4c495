// Checkpoints of a renderer: what it gives, and how it goes on from one.
#include "host/render/renderer.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

// The last end of a block up to `sample`, but not before `begin`.
std::uint32_t finishedBlocks(std::uint32_t begin, std::uint32_t sample)
{
    const std::uint32_t start = sample / blockSamples(sample) * blockSamples(sample);
    return std::max(begin, start);
}

}  // namespace

std::optional<Checkpoint> Renderer::checkpoint() const
{
    const bool adaptive = isNeighbours(settings_.adaptive);
    Checkpoint checkpoint;
    checkpoint.sample = finishedBlocks(settings_.sampleBegin, sample_);
    if (isCourse(settings_.adaptive) || (adaptive && checkpoint.sample != sample_)) {
        return std::nullopt;
    }
    const std::size_t done = pixelsDone();
    const bool ahead = sweeping_ && !choosing_ && endsBlock(sweepEnd());
    checkpoint.pixelsAhead = ahead ? static_cast<std::uint32_t>(done) : 0;
    if (checkpoint.sample == settings_.sampleBegin && checkpoint.pixelsAhead == 0) {
        return std::nullopt;
    }
    checkpoint.film = film_;
    checkpoint.film.sampleRanges = {{settings_.sampleBegin, checkpoint.pixelsAhead > 0 ? sweepEnd() : checkpoint.sample}};
    checkpoint.film.complete = checkpoint.pixelsAhead == 0;
    checkpoint.film.seconds = resumedSeconds_ + secondsSinceStart();
    checkpoint.page.reserve(film_.pixels.size());
    for (const auto& tile : tiles_) {
        const std::vector<PixelMoments> pages = tile->readPages();
        checkpoint.page.insert(checkpoint.page.end(), pages.begin(), pages.end());
    }
    checkpoint.lightSample = checkpoint.sample;
    if (light_) {
        checkpoint.lightSample = light_->finishedSample();
        checkpoint.pageSplats = light_->page();
    }
    const auto clearIfEmpty = [](auto& moments) {
        if (std::ranges::all_of(moments, [](const auto& pixel) { return pixel.count == 0; })) {
            moments.clear();
        }
    };
    clearIfEmpty(checkpoint.page);
    clearIfEmpty(checkpoint.pageSplats);
    if (adaptive) {
        checkpoint.adaptive = AdaptiveProgress{mean_, roundEnd_, commonEnd_, chosenBlocks_.begin(), choosing_};
        checkpoint.common = common_.pixels;
        checkpoint.commonSplats = common_.splats;
        checkpoint.chosen = chosenBlocks_.samples();
        checkpoint.blocksLeft = chosenBlocks_.blocks();
        for (std::size_t i = done; choosing_ && i < sweep_.pixels.size(); ++i) {
            checkpoint.chosen[sweep_.pixels[i].pixel] -= sweep_.sampleCount;
            checkpoint.blocksLeft[sweep_.pixels[i].pixel] += sweep_.sampleCount / kBlockSamples;
        }
        const std::uint32_t most = *std::ranges::max_element(checkpoint.chosen);
        if (most > 0) {
            checkpoint.film.sampleRanges.emplace_back(chosenBlocks_.begin(), chosenBlocks_.begin() + most);
        }
        checkpoint.film.complete = mean_ > 0 && isBetweenRounds();
    }
    return checkpoint;
}

bool Renderer::canResume(const Checkpoint& checkpoint) const
{
    const std::uint32_t end = checkpoint.pixelsAhead > 0 ? blockEnd(checkpoint.sample) : checkpoint.sample;
    return end <= settings_.sampleEnd && checkpoint.adaptive.has_value() == isNeighbours(settings_.adaptive) &&
           (!checkpoint.adaptive || checkpoint.adaptive->chosenBegin == chosenBlocks_.begin());
}

void Renderer::resume(Checkpoint checkpoint)
{
    const Film fresh = std::exchange(film_, std::move(checkpoint.film));
    film_.identity = fresh.identity;  // without what a film's file says of its camera
    film_.device += film_.device.find(fresh.device) == std::string::npos ? "; " + fresh.device : "";
    addArithmetic(film_, fresh.arithmetic);
    resumedSeconds_ = film_.seconds;
    sample_ = checkpoint.sample;
    aheadEnd_ = checkpoint.pixelsAhead > 0 ? blockEnd(sample_) : 0;
    sweeping_ = checkpoint.pixelsAhead > 0;
    for (std::size_t i = 0; i < tiles_.size() && !checkpoint.page.empty(); ++i) {
        tiles_[i]->writePages(std::span(checkpoint.page).subspan(tiles_[i]->begin() - settings_.firstPixel(), tiles_[i]->count()));
    }
    tile_ = checkpoint.pixelsAhead / settings_.tilePixels;
    pixel_ = checkpoint.pixelsAhead % settings_.tilePixels;
    if (light_) {
        light_->resume(checkpoint.lightSample, std::move(checkpoint.pageSplats));
    }
    pictureSamples_ = film_.pixels.size() * (sample_ - settings_.sampleBegin);
    pictureSamples_ += sweeping_ ? std::uint64_t{checkpoint.pixelsAhead} * (aheadEnd_ - sample_) : 0;
    if (checkpoint.adaptive) {
        const AdaptiveProgress& adaptive = *checkpoint.adaptive;
        mean_ = adaptive.mean;
        roundEnd_ = adaptive.roundEnd;
        commonEnd_ = adaptive.commonEnd;
        common_.pixels = std::move(checkpoint.common);
        common_.splats = std::move(checkpoint.commonSplats);
        for (const std::uint32_t samples : checkpoint.chosen) {
            pictureSamples_ += samples;
        }
        chosenBlocks_ = BlockQueue(adaptive.chosenBegin, std::move(checkpoint.chosen), std::move(checkpoint.blocksLeft));
        choosing_ = adaptive.choosing && chooseSweep(chosenBlocks_);
        if (adaptive.choosing && !choosing_) {
            endRound();
        }
    }
    resumedSamples_ = statistics_.resumedSamples = pictureSamples_;
    foldVersion_ = nextFoldVersion();
}

}  // namespace glim
