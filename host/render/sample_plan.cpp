#include "host/render/sample_plan.hpp"

#include "host/render/allocate_samples.hpp"
#include "host/render/film_halves.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace glim {
namespace {

// The last end of a block up to `sample`, but not before `begin`.
std::uint32_t finishedBlocks(std::uint32_t begin, std::uint32_t sample)
{
    return std::max(begin, sample / blockSamples(sample) * blockSamples(sample));
}

// Whether a uniform render with a target judges its error after the samples from `begin` to `end`: at ends of blocks, at least a tenth
// apart. Judging more often would stop where the estimate happens to be low, and takes time.
bool isJudgedAt(std::uint32_t begin, std::uint32_t end)
{
    std::uint32_t judged = 0, sample = begin;
    while (sample < end) {
        sample = blockEnd(sample);
        const std::uint32_t count = sample - begin;
        if (count >= minSamplesForError(begin) && count >= 1.1 * judged) {
            judged = count;
        }
    }
    return sample == end && judged == end - begin && judged > 0;
}

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

// The samples that all pixels share are never more than half of sampleEnd. Those of chosen pixels begin with a block behind that.
std::uint32_t chosenBegin(const RenderSettings& settings)
{
    const std::uint32_t half = std::max(kPilotSamples, (settings.sampleEnd + 1) / 2);
    return (half + kBlockSamples - 1) / kBlockSamples * kBlockSamples;
}

}  // namespace

std::uint32_t blockEnd(std::uint32_t sample) { return (sample / blockSamples(sample) + 1) * blockSamples(sample); }

std::vector<std::uint32_t> countByTile(const std::vector<PixelStart>& pixels, const RenderSettings& settings)
{
    std::vector<std::uint32_t> counts((settings.pixelCount() + settings.tileSize() - 1) / settings.tileSize(), 0);
    for (const PixelStart& each : pixels) {
        ++counts[each.pixel / settings.tileSize()];
    }
    return counts;
}

CameraPass SweepCursor::next(std::uint32_t firstSample, std::uint32_t sampleCount, std::uint32_t paths) const
{
    const std::uint32_t pixels = std::min(counts_[tile_] - pixel_, std::max(1U, paths / sampleCount));
    return {tile_, pixel_, pixels, firstSample, sampleCount};
}

void SweepCursor::finish(const CameraPass& pass)
{
    pixel_ += pass.pixelCount;
    skipTiles();
}

void SweepCursor::skipTiles()
{
    while (tile_ < counts_.size() && pixel_ == counts_[tile_]) {
        ++tile_;
        pixel_ = 0;
    }
}

void SweepCursor::restart()
{
    tile_ = 0;
    pixel_ = 0;
    skipTiles();
}

std::uint64_t SweepCursor::pixels() const { return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}); }

std::size_t SweepCursor::pixelsDone() const
{
    return std::accumulate(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(tile_), std::size_t{pixel_});
}

void SweepCursor::skip(std::size_t pixels)
{
    while (pixels > 0) {
        const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(pixels, counts_[tile_]));
        finish({.pixelCount = count});
        pixels -= count;
    }
}

void SampleProgress::describe(Film& film, std::uint32_t begin) const
{
    film.sampleRanges = {{begin, pixelsAhead > 0 ? blockEnd(sample) : sample}};
    film.complete = adaptive ? adaptive->mean > 0 && adaptive->mean == adaptive->roundEnd : pixelsAhead == 0;
    const std::uint32_t most = adaptive ? *std::ranges::max_element(adaptive->chosen) : 0;
    if (most > 0) {
        film.sampleRanges.emplace_back(adaptive->chosenBegin, adaptive->chosenBegin + most);
    }
}

SamplePlan::SamplePlan(const RenderSettings& settings, bool tracesLight)
    : settings_(settings),
      tracesLight_(tracesLight),
      sample_(settings.sampleBegin),
      lightSample_(settings.sampleBegin),
      cursor_(tileCounts()),
      chosen_(settings.pixelCount()),
      plannedSamples_(chosen_ * (settings.sampleEnd - settings.sampleBegin))
{
    if (isNeighbours(settings.adaptive)) {
        chosenBlocks_ = BlockQueue(settings.pixelCount(), chosenBegin(settings));
    }
}

// All pixels of each tile.
std::vector<std::uint32_t> SamplePlan::tileCounts() const
{
    std::vector<std::uint32_t> counts;
    for (std::uint32_t first = 0; first < settings_.pixelCount(); first += settings_.tileSize()) {
        counts.push_back(std::min(settings_.tileSize(), settings_.pixelCount() - first));
    }
    return counts;
}

bool SamplePlan::canResume(const SampleProgress& progress) const
{
    const std::uint32_t end = progress.pixelsAhead > 0 ? blockEnd(progress.sample) : progress.sample;
    return end <= settings_.sampleEnd && progress.adaptive.has_value() == isNeighbours(settings_.adaptive) &&
           (!progress.adaptive || progress.adaptive->chosenBegin == chosenBlocks_.begin());
}

void SamplePlan::resume(SampleProgress progress, std::uint32_t paths)
{
    sample_ = progress.sample;
    lightSample_ = progress.lightSample;
    sweeping_ = progress.pixelsAhead > 0;
    aheadEnd_ = sweeping_ ? blockEnd(sample_) : 0;
    cursor_.skip(progress.pixelsAhead);
    pictureSamples_ = std::uint64_t{settings_.pixelCount()} * (sample_ - settings_.sampleBegin);
    pictureSamples_ += sweeping_ ? std::uint64_t{progress.pixelsAhead} * (aheadEnd_ - sample_) : 0;
    if (AdaptiveProgress* adaptive = progress.adaptive ? &*progress.adaptive : nullptr) {
        mean_ = adaptive->mean;
        roundEnd_ = adaptive->roundEnd;
        commonEnd_ = adaptive->commonEnd;
        pictureSamples_ = std::accumulate(adaptive->chosen.begin(), adaptive->chosen.end(), pictureSamples_);
        chosenBlocks_ = BlockQueue(adaptive->chosenBegin, std::move(adaptive->chosen), std::move(adaptive->blocksLeft));
        laterBlocks_ = std::move(adaptive->blocksLater);
        second_ = adaptive->second;
        if (adaptive->choosing) {
            startChosenSweep(paths);
        }
    }
    resumedSamples_ = pictureSamples_;
}

std::optional<SampleProgress> SamplePlan::progress() const
{
    const bool adaptive = isNeighbours(settings_.adaptive);
    SampleProgress progress;
    progress.sample = finishedBlocks(settings_.sampleBegin, sample_);
    if (isCourse(settings_.adaptive) || (adaptive && progress.sample != sample_)) {
        return std::nullopt;
    }
    const bool ahead = sweeping_ && !choosing_ && endsBlock(sweepEnd()) && !settings_.halves;
    progress.pixelsAhead = ahead ? static_cast<std::uint32_t>(cursor_.pixelsDone()) : 0;
    if (progress.sample == settings_.sampleBegin && progress.pixelsAhead == 0) {
        return std::nullopt;
    }
    progress.lightSample = tracesLight_ ? finishedBlocks(settings_.sampleBegin, lightSample_) : progress.sample;
    if (adaptive) {
        AdaptiveProgress& now =
            progress.adaptive.emplace(AdaptiveProgress{mean_, roundEnd_, commonEnd_, chosenBlocks_.begin(), choosing_, second_,
                                                       chosenBlocks_.samples(), chosenBlocks_.blocks(), laterBlocks_});
        for (std::size_t i = cursor_.pixelsDone(); choosing_ && i < sweep_.pixels.size(); ++i) {
            now.chosen[sweep_.pixels[i].pixel] -= sweep_.sampleCount;
            now.blocksLeft[sweep_.pixels[i].pixel] += sweep_.sampleCount / kBlockSamples;
        }
    }
    return progress;
}

// The end of the current sweep. The first samples are swept 1, 1, 2, 4, 8, 16 and 32 at a time, so that a render that is stopped early
// covers its picture evenly. Later blocks are swept whole, which keeps the rays of a pixel together.
std::uint32_t SamplePlan::sweepEnd() const
{
    if (sample_ < aheadEnd_) {
        return aheadEnd_;
    }
    const std::uint32_t done = sample_ - settings_.sampleBegin;
    const std::uint32_t last = isNeighbours(settings_.adaptive) ? commonEnd_ : settings_.sampleEnd;
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t most = settings_.halves ? FilmHalves::nextEnd(sample_) : (sample_ / kBlockSamples + 1) * kBlockSamples;
    const std::uint32_t end = std::min({last, most, sample_ + count});
    return isCourse(settings_.adaptive) ? std::min(end, (sample_ / settings_.course.batch + 1) * settings_.course.batch) : end;
}

// Light paths go before the camera's, so that a render that is stopped lacks none. Samples that only chosen pixels have need none of their
// own, but then all light paths are as many as if every pixel had the mean of samples, in whole blocks.
std::uint32_t SamplePlan::lightEnd() const
{
    const std::uint32_t ofRound = std::max(commonEnd_, roundEnd_ / kBlockSamples * kBlockSamples);
    return isNeighbours(settings_.adaptive) ? ofRound : sweepEnd();
}

// All pixels get the same half of a round's samples, down to whole blocks but at least kPilotSamples. These alone decide who gets the
// other half. If there is a target, the round goes no further than it is expected to need.
bool SamplePlan::beginRound()
{
    if (!isNeighbours(settings_.adaptive) || !isBetweenRounds() || isDone()) {
        return false;
    }
    const auto most = static_cast<double>(std::min(usualRoundEnd(mean_), settings_.sampleEnd));
    const double wanted = mean_ == 0 ? most : mean_ * std::max(1.12, 1.02 * timesToTarget_);
    roundEnd_ = static_cast<std::uint32_t>(std::ceil(std::min(most, wanted)));
    commonEnd_ = std::max(std::min(kPilotSamples, roundEnd_), roundEnd_ / 2 / kBlockSamples * kBlockSamples);
    if (sample_ == commonEnd_) {
        tasks_.push_back(PlanTask::Allocate);
    } else {
        tasks_.push_back(PlanTask::ChooseAllPixels);
        cursor_ = SweepCursor(tileCounts());
    }
    return true;
}

std::optional<PlanTask> SamplePlan::takeTask()
{
    if (tasks_.empty()) {
        return std::nullopt;
    }
    const PlanTask task = tasks_.front();
    tasks_.pop_front();
    return task;
}

std::optional<LightPass> SamplePlan::nextLight(std::uint32_t paths) const
{
    if (!tracesLight_ || lightSample_ >= lightEnd()) {
        return std::nullopt;
    }
    const std::uint32_t end = settings_.halves ? FilmHalves::nextEnd(lightSample_) : blockEnd(lightSample_);
    const std::uint32_t most = std::min(lightEnd(), end) - lightSample_;
    return LightPass{lightSample_, std::clamp(paths / lightPathCount(settings_.width, settings_.height), 1U, most)};
}

CameraPass SamplePlan::next(std::uint32_t paths) const
{
    // Each chosen pixel of a round has its own first sample.
    return choosing_ ? cursor_.next(0, sweep_.sampleCount, paths) : cursor_.next(sample_, sweepEnd() - sample_, paths);
}

void SamplePlan::finish(const CameraPass& pass, std::uint32_t paths)
{
    sweeping_ = true;
    pictureSamples_ += pass.paths();
    cursor_.finish(pass);
    if (cursor_.isAtEnd()) {
        if (choosing_) {
            startChosenSweep(paths);
        } else {
            endSweep(paths);
        }
    }
}

void SamplePlan::endSweep(std::uint32_t paths)
{
    sample_ = sweepEnd();
    sweeping_ = false;
    if (isCourse(settings_.adaptive) && sample_ % settings_.course.batch == 0) {
        tasks_.push_back(PlanTask::TestPixels);
    } else {
        cursor_.restart();
    }
    if (settings_.halves && sample_ == FilmHalves::nextEnd(sample_ - 1)) {
        tasks_.push_back(PlanTask::TakeHalves);
    }
    if (!isNeighbours(settings_.adaptive)) {
        if (sample_ % kPageSamples == 0) {
            tasks_.push_back(PlanTask::Fold);
        }
    } else if (sample_ == commonEnd_) {
        tasks_.push_back(PlanTask::FoldCommon);
        if (roundEnd_ > commonEnd_) {
            tasks_.push_back(PlanTask::Allocate);
        } else {
            startChosenSweep(paths);
        }
    }
}

void SamplePlan::choose(std::vector<std::uint32_t> counts)
{
    cursor_ = SweepCursor(std::move(counts));
    chosen_ = cursor_.pixels();
    plannedSamples_ = pictureSamples_ + chosen_ * (settings_.sampleEnd - sample_);
}

void SamplePlan::allocate(const std::vector<double>& shares, const FilmHalves* halves, std::uint32_t paths)
{
    std::vector<std::uint32_t> blocks = allocateBlocks(shares, chosenBlocks_.samples(), roundEnd_ - commonEnd_);
    if (halves != nullptr) {
        laterBlocks_ = blocks;
        const auto& [first, second] = halves->films();
        const auto countOf = [](const Film& half, std::size_t i) {
            return i < half.pixels.size() ? half.pixels[i].count : 0;  // a film from a file may lack a half
        };
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            blocks[i] = blocksOfFirstHalf(countOf(first, i), countOf(second, i), blocks[i]);
            laterBlocks_[i] -= blocks[i];
        }
    }
    chosenBlocks_.add(blocks);
    startChosenSweep(paths);
}

// Ends the round if no pixel is to have more.
void SamplePlan::startChosenSweep(std::uint32_t paths)
{
    auto sweep = chosenBlocks_.take(paths);
    if (!sweep && !laterBlocks_.empty()) {
        tasks_.push_back(PlanTask::TakeFirstHalf);
        chosenBlocks_.add(std::exchange(laterBlocks_, {}));
        second_ = true;
        sweep = chosenBlocks_.take(paths);
    }
    choosing_ = sweep.has_value();
    if (choosing_) {
        sweep_ = *std::move(sweep);
        cursor_ = SweepCursor(countByTile(sweep_.pixels, settings_));
        tasks_.push_back(PlanTask::ChoosePixels);
    } else {
        if (std::exchange(second_, false)) {
            tasks_.push_back(PlanTask::TakeSecondHalf);
        }
        sweeping_ = false;
        mean_ = roundEnd_;
        tasks_.push_back(PlanTask::Fold);
    }
}

void SamplePlan::expectTarget() { plannedSamples_ = std::uint64_t{settings_.pixelCount()} * minSamplesForError(settings_.sampleBegin); }

bool SamplePlan::isJudgedNow() const
{
    const bool due = isNeighbours(settings_.adaptive) ? isBetweenRounds() && mean_ >= minSamplesForError(settings_.sampleBegin)
                                                      : isJudgedAt(settings_.sampleBegin, sample_);
    return !sweeping_ && due && judgedSamples_ != pictureSamples_;
}

bool SamplePlan::judge(double timesToTarget)
{
    judgedSamples_ = pictureSamples_;
    timesToTarget_ = timesToTarget;
    plannedSamples_ = static_cast<std::uint64_t>(static_cast<double>(pictureSamples_) * std::max(timesToTarget_, 1.0));
    return timesToTarget_ <= 1.0;
}

void SamplePlan::describe(Film& film) const
{
    film.sampleRanges = {{settings_.sampleBegin, endOfSamples()}};
    if (isNeighbours(settings_.adaptive)) {
        if (chosenBlocks_.end() > chosenBlocks_.begin()) {
            film.sampleRanges.emplace_back(chosenBlocks_.begin(), chosenBlocks_.end());
        }
        film.complete = mean_ > 0 && isBetweenRounds();
    } else {
        const bool even = pictureSamples_ > 0 && pictureSamples_ == std::uint64_t{settings_.pixelCount()} * sampleCount();
        film.complete = isDone() || (even && !isCourse(settings_.adaptive));
    }
}

}  // namespace glim
