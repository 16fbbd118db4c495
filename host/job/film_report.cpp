#include "host/job/film_report.hpp"

#include "host/measure/error_bound.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace glim {
namespace {

double meanOf(const glm::dvec3& value) { return (value.r + value.g + value.b) / 3.0; }

template <class Value>
double computeMean(const Film& film, Value value)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : shownPixels(film)) {
        sum += static_cast<double>(value(pixel));
    }
    return sum / static_cast<double>(film.pixels.size());
}

// Nothing for AOVs other than radiance, whose noise is negligible. Nothing if an adaptive render has stopped a pixel after one block of
// samples: its error is unknown, and the other pixels do not stand for it.
std::optional<ErrorEstimate> findEstimate(const Film& film, const RenderSettings& settings)
{
    const bool stops = isCourse(settings.adaptive);
    if (settings.aov != Aov::Radiance || (stops && computeRates(film).fewestBlocks < 2)) {
        return std::nullopt;
    }
    return estimateError(film);
}

std::optional<double> findBound(const Film& film, const RenderSettings& settings)
{
    if (settings.aov != Aov::Radiance || isCourse(settings.adaptive) || pixelsWithoutError(film) == 0) {
        return std::nullopt;
    }
    const Picture picture = makePicture(film);
    const std::optional<double> mse = boundMse(picture);
    const double share = mse ? relativeRoot(*mse, meanRadiance(picture)) : 0.0;
    return share > 0.0 && std::isfinite(share) ? std::optional(share) : std::nullopt;
}

}  // namespace

Rates computeRates(const Film& film)
{
    const auto fewer = [](const PixelMoments& a, const PixelMoments& b) { return a.count < b.count; };
    const auto [least, most] = std::minmax_element(film.pixels.begin(), film.pixels.end(), fewer);
    const auto blocks = std::min_element(film.pixels.begin(), film.pixels.end(),
                                         [](const PixelMoments& a, const PixelMoments& b) { return a.blocks < b.blocks; });
    return {computeMean(film, [](const PixelMoments& p) { return p.count; }), least->count, most->count, blocks->blocks};
}

Steps computeSteps(const Film& film)
{
    const auto fewer = [](const PixelMoments& a, const PixelMoments& b) { return a.mean.r < b.mean.r; };
    return {computeMean(film, [](const PixelMoments& p) { return p.mean.r; }),
            computeMean(film, [](const PixelMoments& p) { return p.mean.g; }),
            static_cast<double>(std::max_element(film.pixels.begin(), film.pixels.end(), fewer)->mean.r)};
}

ClampedEnergy computeClampedEnergy(const Film& film)
{
    return {computeMean(film, [](const PixelMoments& p) { return p.clamped; }),
            computeMean(film, [](const PixelMoments& p) { return meanOf(p.mean); })};
}

double timesToTarget(const Film& film, const ErrorTarget& target)
{
    const auto estimate = estimateError(film);
    if (!estimate || pixelsWithoutError(film) > 0) {
        return std::numeric_limits<double>::infinity();
    }
    return timesToTarget(target, estimate->errors.relMse, relativeRoot(estimate->errors.mse, estimate->mean));
}

double timesToTarget(const ErrorTarget& target, double relMse, double rmse)
{
    const double root = target.rmse ? rmse / *target.rmse : 0.0;
    const double times = std::max(target.relMse ? relMse / *target.relMse : 0.0, root * root);
    return std::isfinite(relMse) && std::isfinite(rmse) ? times : std::numeric_limits<double>::infinity();
}

std::size_t pixelsWithoutError(const Film& film)
{
    return static_cast<std::size_t>(
        std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& pixel) { return pixel.blocks < 2; }));
}

FilmError findError(const Film& film, const RenderSettings& settings) { return {findEstimate(film, settings), findBound(film, settings)}; }

std::string whyUnknown(const Film& film)
{
    if (const std::size_t pixels = pixelsWithoutError(film); pixels > 0) {
        return std::to_string(pixels) + " pixels have too few samples";
    }
    const double mean = computeMean(film, [](const PixelMoments& p) { return meanOf(p.mean); });
    const double variance = computeMean(film, [](const PixelMoments& p) { return meanOf(computeVarianceOfMean(p)); });
    return mean == 0.0                                      ? "the picture is black"
           : std::isfinite(mean) && std::isfinite(variance) ? "its radiance is so small that float32 does not hold the squares"
                                                            : "its radiance is so large that float32 does not hold the squares";
}

Json describeEstimate(const FilmError& error)
{
    const std::optional<ErrorEstimate>& estimate = error.estimate;
    if (!estimate) {
        return nullptr;
    }
    const auto root = [&](double meanSquare) { return relativeRoot(meanSquare, estimate->mean); };
    return {{"relmse", estimate->errors.relMse},
            {"relmse95", Json::array({estimate->relMse.low, estimate->relMse.high})},
            {"relmseAbsolute", estimate->errors.relMseAbsolute},
            {"mse", estimate->errors.mse},
            {"mse95", Json::array({estimate->mse.low, estimate->mse.high})},
            {"rmse", std::sqrt(estimate->errors.mse)},
            {"rmseOfMean", root(estimate->errors.mse)},
            {"rmseOfMean95", Json::array({root(estimate->mse.low), root(estimate->mse.high)})},
            {"mean", estimate->mean},
            {"pixelsOfHalf", estimate->pixelsOfHalf}};
}

std::string errorText(const FilmError& error, const Film& film, const RenderSettings& settings)
{
    const std::optional<ErrorEstimate>& estimate = error.estimate;
    if (!estimate) {
        return error.bound ? format(", RMSE at most %.3g %% of the mean (by how neighbouring pixels differ; more samples give an estimate)",
                                    100.0 * *error.bound)
                           : ", error unknown: " + whyUnknown(film);
    }
    const auto percent = [&](double meanSquare) { return 100.0 * relativeRoot(meanSquare, estimate->mean); };
    std::string text =
        format(", estimated relMSE %.3g [%.3g, %.3g], RMSE %.3g %% [%.3g, %.3g] of the mean", estimate->errors.relMse, estimate->relMse.low,
               estimate->relMse.high, percent(estimate->errors.mse), percent(estimate->mse.low), percent(estimate->mse.high));
    if (estimate->isOfFew()) {
        text += format(", half of the MSE in %zu pixels, so the intervals are unreliable", estimate->pixelsOfHalf);
    }
    return isCourse(settings.adaptive) ? text + ", without the bias of the stopping rule" : text;
}

}  // namespace glim
