#include "host/job/denoising.hpp"

#include "host/clock.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/text.hpp"

#include <cstdio>
#include <limits>
#include <utility>

namespace glim {
void FilmDenoiser::open(const RenderJob& options)
{
    if (options.oidn && (!oidn_ || *options.oidn != oidnPath_)) {
        oidn_.reset();
        oidn_.emplace(*options.oidn);
        oidnPath_ = *options.oidn;
    }
}

std::optional<Denoising> FilmDenoiser::denoise(const RenderJob& options, Renderer& renderer, const std::function<bool()>& shouldContinue)
{
    const FilmHalves* halves = renderer.films().halves();
    if (halves == nullptr || !hasBothHalves(*halves) || !shouldContinue()) {
        return std::nullopt;
    }
    const auto start = Clock::now();
    open(options);
    if (!options.oidn && !nlMeans_) {
        nlMeans_.emplace(renderer.resources().device);
    }
    auto picture = denoiseHalves(*halves, [&](const Film& film) {
        return options.oidn ? std::optional(oidn_->denoise(film)) : nlMeans_->denoise(film, shouldContinue);
    });
    if (!picture) {
        return std::nullopt;
    }
    const double seconds = secondsSince(start);
    return Denoising{*std::move(picture), options.oidn ? oidn_->name() : NlMeans::kName, seconds};
}

double timesToTarget(const DenoisedError& error, const ErrorTarget& target)
{
    return error.isKnown() ? timesToTarget(target, error.relMse, relativeRoot(error.mse.value, error.mean))
                           : std::numeric_limits<double>::infinity();
}

std::string denoisingText(const Denoising& denoising)
{
    const DenoisedError& error = denoising.picture.measured;
    if (!error.isKnown()) {
        return ", denoised: error unknown";
    }
    const auto percent = [&](double meanSquare) { return 100.0 * relativeRoot(meanSquare, error.mean); };
    std::string text = format(", denoised: measured RMSE %.3g %% [%.3g, %.3g] of the mean (noisy %.3g %%), relMSE about %.3g (noisy %.3g)",
                              percent(error.mse.value), percent(error.mse.low), percent(error.mse.high), percent(error.noisyMse),
                              error.relMse, error.noisyRelMse);
    if (denoising.picture.noisyShare > 0.0) {
        text += format(", %.2g %% of the pixels stayed noisy", 100.0 * denoising.picture.noisyShare);
    }
    return text;
}

Json denoisingJson(const Denoising& denoising)
{
    const DenoisedError& error = denoising.picture.measured;
    const auto known = [&](double figure) { return error.isKnown() ? Json(figure) : Json(nullptr); };
    const auto root = [&](double meanSquare) { return known(relativeRoot(meanSquare, error.mean)); };
    return {{"denoiser", denoising.denoiser},
            {"seconds", denoising.seconds},
            {"relmse", known(error.relMse)},
            {"mse", known(error.mse.value)},
            {"mse95", Json::array({known(error.mse.low), known(error.mse.high)})},
            {"rmseOfMean", root(error.mse.value)},
            {"rmseOfMean95", Json::array({root(error.mse.low), root(error.mse.high)})},
            {"mean", error.mean},
            {"noisyRelmse", known(error.noisyRelMse)},
            {"noisyMse", known(error.noisyMse)},
            {"noisyShare", denoising.picture.noisyShare}};
}

}  // namespace glim
