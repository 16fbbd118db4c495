#include "host/cli/denoising.hpp"

#include "host/measure/error_estimate.hpp"

#include <cstdio>

namespace glim {
namespace {

std::string format(const char* pattern, auto... values)
{
    char text[256];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

}  // namespace

Film showDenoised(Film film, const Denoising& denoising)
{
    film.splats.clear();
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i].mean = denoising.picture.radiance[i];
    }
    return film;
}

std::string denoisingText(const Denoising& denoising)
{
    const DenoisedError& error = denoising.picture.measured;
    const auto percent = [&](double meanSquare) { return 100.0 * relativeRoot(meanSquare, error.mean); };
    std::string text = format(", denoised: measured relMSE %.3g [%.3g, %.3g]", error.relMse.value, error.relMse.low, error.relMse.high);
    if (error.relMse.value > 0.0) {
        text += format(", noisy / %.3g", error.noisyRelMse / error.relMse.value);
    }
    text += format(", RMSE %.3g %% [%.3g, %.3g] of the mean", percent(error.mse.value), percent(error.mse.low), percent(error.mse.high));
    if (denoising.picture.noisyShare > 0.0) {
        text += format(", %.2g %% of the pixels stayed noisy", 100.0 * denoising.picture.noisyShare);
    }
    return text;
}

Json denoisingJson(const Denoising& denoising)
{
    const DenoisedError& error = denoising.picture.measured;
    const auto root = [&](double meanSquare) { return relativeRoot(meanSquare, error.mean); };
    const auto pair = [](const Interval& interval) { return Json::array({interval.low, interval.high}); };
    return {{"denoiser", denoising.denoiser},
            {"seconds", denoising.seconds},
            {"relmse", error.relMse.value},
            {"relmse95", pair(error.relMse)},
            {"mse", error.mse.value},
            {"mse95", pair(error.mse)},
            {"rmseOfMean", root(error.mse.value)},
            {"rmseOfMean95", Json::array({root(error.mse.low), root(error.mse.high)})},
            {"mean", error.mean},
            {"noisyRelmse", error.noisyRelMse},
            {"noisyMse", error.noisyMse},
            {"noisyShare", denoising.picture.noisyShare}};
}

}  // namespace glim
