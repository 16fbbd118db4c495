#include "host/cli/error_report.hpp"

#include "host/cli/film_figures.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace glim {
namespace {

// Of light alone: other views have no noise worth the name. Nothing if pixels that an adaptive render has stopped have one block
// of samples, which tells no error: the rest would not stand for them.
std::optional<ErrorEstimate> knownError(const Film& film, const RenderSettings& settings)
{
    const bool stops = isCourse(settings.adaptive);
    if (settings.view != View::Shaded || (stops && computeRates(film).fewestBlocks < 2)) {
        return std::nullopt;
    }
    return estimateError(film);
}

std::string format(const char* pattern, auto... values)
{
    char text[256];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

}  // namespace

double timesToTarget(const Film& film, const ErrorTarget& target)
{
    const auto estimate = estimateError(film);
    if (!estimate || pixelsWithoutError(film) > 0) {
        return std::numeric_limits<double>::infinity();
    }
    double times = 0.0;
    if (target.relMse) {
        times = estimate->errors.relMse / *target.relMse;
    }
    if (target.rmse) {
        const double root = relativeRoot(estimate->errors.mse, estimate->mean) / *target.rmse;
        times = std::max(times, root * root);
    }
    return times;
}

std::size_t pixelsWithoutError(const Film& film)
{
    return static_cast<std::size_t>(
        std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& pixel) { return pixel.blocks < 2; }));
}

nlohmann::ordered_json estimateOf(const Film& film, const RenderSettings& settings)
{
    const auto estimate = knownError(film, settings);
    if (!estimate) {
        return nullptr;
    }
    const auto root = [&](double meanSquare) { return relativeRoot(meanSquare, estimate->mean); };
    return {{"relmse", estimate->errors.relMse},
            {"relmse95", {estimate->relMse.low, estimate->relMse.high}},
            {"relmseAbsolute", estimate->errors.relMseAbsolute},
            {"mse", estimate->errors.mse},
            {"mse95", {estimate->mse.low, estimate->mse.high}},
            {"rmse", std::sqrt(estimate->errors.mse)},
            {"rmseOfMean", root(estimate->errors.mse)},
            {"rmseOfMean95", {root(estimate->mse.low), root(estimate->mse.high)}},
            {"mean", estimate->mean},
            {"pixelsOfHalf", estimate->pixelsOfHalf}};
}

std::string errorText(const Film& film, const RenderSettings& settings)
{
    const auto estimate = knownError(film, settings);
    if (!estimate) {
        return format(", error unknown since %zu pixels have one block of samples at most", pixelsWithoutError(film));
    }
    const auto percent = [&](double meanSquare) { return 100.0 * relativeRoot(meanSquare, estimate->mean); };
    std::string text = format(", estimated relMSE %.3g [%.3g, %.3g], RMSE %.3g %% [%.3g, %.3g] of the mean",
                              estimate->errors.relMse, estimate->relMse.low, estimate->relMse.high,
                              percent(estimate->errors.mse), percent(estimate->mse.low), percent(estimate->mse.high));
    if (estimate->isOfFew()) {
        text += format(", half of it in %zu pixels, so the interval is worth little", estimate->pixelsOfHalf);
    }
    return isCourse(settings.adaptive) ? text + " besides the rule's bias" : text;
}

}  // namespace glim
