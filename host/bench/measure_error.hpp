// How far one picture of a bench is from the reference, and what the pictures of all seeds have in common.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/measure/picture.hpp"

namespace glim {

struct PictureError {
    double mean = 0.0;  // of the picture
    double mse = 0.0, relMse = 0.0, trimmedRelMse = 0.0;
    std::vector<float> terms;  // (x - r) / sqrt(r^2 + eps), 0 where either is not finite: relMse is their mean square
};

// Refuses (InputError) pictures of different sizes.
PictureError measureError(const Picture& picture, const Picture& reference);

// From the reference's variance.
Floor measureFloor(const Picture& reference);

// `terms` of independent renders, at least 3.
Bias estimateBias(const std::vector<std::vector<float>>& terms, const Floor& floor);

}  // namespace glim
