// What a render tells of its error, and whether that is small enough.
#pragma once

#include "host/measure/error_estimate.hpp"
#include "host/render/settings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace glim {

// What --target-rmse and --target-relmse ask for.
struct ErrorTarget {
    std::optional<double> rmse;    // relative to the picture's mean
    std::optional<double> relMse;

    bool isGiven() const { return rmse || relMse; }
};

// How many times its samples a film needs to reach the target; at most 1: it is reached. Infinite while its error is not known.
double timesToTarget(const Film& film, const ErrorTarget& target);

// Pixels that are of one block of samples.
std::size_t pixelsWithoutError(const Film& film);

// null where the error is not known.
nlohmann::ordered_json estimateOf(const Film& film, const RenderSettings& settings);

// As in ", estimated relMSE .001 [.0009, .0011], RMSE 2 % [...] of the mean".
std::string errorText(const Film& film, const RenderSettings& settings);

}  // namespace glim
