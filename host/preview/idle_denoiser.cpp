#include "host/preview/idle_denoiser.hpp"

#include "host/measure/error_estimate.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <chrono>

namespace glim {
namespace {

constexpr double kPieceSeconds = 0.1;
constexpr std::uint32_t kBlocksForVariance = 2;

}  // namespace

void IdleDenoiser::restart()
{
    job_.reset();
    result_.reset();
    samples_ = smaller_ = 0;
    isStale_ = measuring_.valid();
}

void IdleDenoiser::renew()
{
    restart();
    nlMeans_.reset();
}

bool IdleDenoiser::begin(Refiner& refiner)
{
    const FilmHalves* halves = refiner.keepHalves() ? refiner.renderer().films().halves() : nullptr;
    if (halves == nullptr || measuring_.valid()) {
        return false;
    }
    const auto& [a, b] = halves->films();
    if (a.pixels.empty() || b.pixels.empty() || std::min(a.pixels[0].blocks, b.pixels[0].blocks) < kBlocksForVariance) {
        return false;
    }
    const std::uint32_t smaller = std::min(a.pixels[0].count, b.pixels[0].count), samples = a.pixels[0].count + b.pixels[0].count;
    const bool isLast = refiner.isDone() && samples > samples_;
    if (!isLast && smaller_ > 0 && smaller < 2 * smaller_) {
        return false;
    }
    if (!nlMeans_) {
        beforeCompiling_();
        nlMeans_.emplace(device_);
    }
    samples_ = samples;
    smaller_ = smaller;
    job_.emplace(Job{{a.width, a.height}, {noisyHalf(a), noisyHalf(b)}, 0, std::make_unique<NlMeans::Work>(*nlMeans_, a)});
    return true;
}

bool IdleDenoiser::work(Refiner& refiner, const std::function<bool()>& shouldContinue)
{
    if (measuring_.valid() && measuring_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        take();
        return true;
    }
    if (!job_ && !begin(refiner)) {
        return false;
    }
    const auto start = Clock::now();
    const bool isWhole = job_->work->advance([&] { return shouldContinue() && secondsSince(start) < kPieceSeconds; });
    if (!isWhole) {
        return true;
    }
    job_->halves[job_->half].denoised = job_->work->takeResult();
    if (++job_->half < 2) {
        const auto& films = refiner.renderer().films().halves()->films();
        job_->work = std::make_unique<NlMeans::Work>(*nlMeans_, films[1]);
        if (films[0].pixels[0].count + films[1].pixels[0].count != samples_) {  // sampling went on while nothing was to be denoised
            job_.reset();
            smaller_ = 0;
        }
        return true;
    }
    measuring_ = std::async(std::launch::async, joinHalves, job_->size, std::move(job_->halves));
    isStale_ = false;
    job_.reset();
    return true;
}

void IdleDenoiser::take()
{
    DenoisedPicture picture = measuring_.get();
    if (!std::exchange(isStale_, false)) {
        result_.emplace(Result{std::move(picture), samples_, ++version_});
    }
}

std::vector<std::string> describe(const IdleDenoiser& denoiser, bool works)
{
    std::vector<std::string> lines;
    if (const IdleDenoiser::Result* result = denoiser.result()) {
        const DenoisedError& error = result->picture.measured;
        const auto percent = [&](double meanSquare) { return 100.0 * relativeRoot(meanSquare, error.mean); };
        lines.push_back(std::to_string(result->samples) + " samples denoised");
        if (error.isKnown()) {
            lines.push_back(
                format("measured RMSE %.3g %% [%.3g, %.3g]", percent(error.mse.value), percent(error.mse.low), percent(error.mse.high)));
            lines.push_back(format("without denoising %.3g %%", percent(error.noisyMse)));
        } else {
            lines.push_back("error unknown");
        }
    }
    if (works && denoiser.isWorking()) {
        lines.push_back("denoising");
    }
    return lines;
}

}  // namespace glim
