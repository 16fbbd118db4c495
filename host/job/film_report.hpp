// Figures of a whole film, and its estimated error.
#pragma once

#include "host/json.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <optional>
#include <string>

namespace glim {

struct Rates {
    double mean;  // samples per pixel
    std::uint32_t least, most;
    std::uint32_t fewestBlocks;  // blocks of the pixel with the fewest; its variance comes from them
};
Rates computeRates(const Film& film);

// Steps of a camera ray with --view bvh-steps: means over the picture, and the largest mean of a pixel.
struct Steps {
    double nodes, primitives, mostNodes;
};
Steps computeSteps(const Film& film);

// The mean radiance that --clamp-indirect removed, and the one that is left.
struct ClampedEnergy {
    double removed, kept;

    double removedShare() const { return removed == 0.0 ? 0.0 : removed / (removed + kept); }
};
ClampedEnergy computeClampedEnergy(const Film& film);

// --target-rmse, --target-relmse and --denoised.
struct ErrorTarget {
    std::optional<double> rmse;  // relative to the picture's mean
    std::optional<double> relMse;
    bool denoised = false;  // of the denoised picture

    bool isGiven() const { return rmse || relMse; }
};

// By what factor a film's samples must grow to reach the target; at most 1: it is reached. Infinite while its error is unknown.
double timesToTarget(const Film& film, const ErrorTarget& target);
// The same for a known relMSE and the RMSE relative to the mean; infinite unless both are finite.
double timesToTarget(const ErrorTarget& target, double relMse, double rmse);

// A render with a target ends after this many samples of a pixel if its error is still unknown.
inline constexpr std::uint32_t kSamplesOfUnknownError = 1024;

// The number of pixels with at most one block of samples.
std::size_t pixelsWithoutError(const Film& film);

// What is known of the error of a film.
struct FilmError {
    std::optional<ErrorEstimate> estimate;
    std::optional<double> bound;  // of the RMSE relative to the mean, where pixels have too few samples for an estimate (boundMse)
};
FilmError findError(const Film& film, const RenderSettings& settings);

// Of a film whose error is unknown, as in "the picture is black".
std::string whyUnknown(const Film& film);

// null where the error is unknown.
Json describeEstimate(const FilmError& error);

// Reads like ", estimated relMSE .001 [.0009, .0011], RMSE 2 % [...] of the mean".
std::string errorText(const FilmError& error, const Film& film, const RenderSettings& settings);

}  // namespace glim
