// The error of a film, estimated from its own blocks of samples.
#pragma once

#include "host/measure/compare_images.hpp"
#include "host/measure/confidence.hpp"

#include <cstddef>
#include <optional>

namespace glim {

struct ErrorEstimate {
    SquaredErrors errors;  // of this film against the truth; biases are not included
    Interval mse, relMse;
    double mean = 0.0;             // radiance over pixels and channels, W/(sr m^2)
    std::size_t pixelsOfHalf = 0;  // the fewest pixels that make up half of mse

    // Too few pixels to tell what others would be like: a light's rim in a small picture, or paths so rare and bright that most are
    // missing.
    bool isOfFew() const { return pixelsOfHalf < 10 && errors.mse > 0.0; }
};

// Pixels of fewer than two blocks are left out. Nothing if there are no others, if a pixel is not finite, and if float32 does not hold the
// squares (float_range.hpp): never a false figure.
std::optional<ErrorEstimate> estimateError(const Film& film);

// The root of a mean square error, relative to `mean`. 0 if the measured error is negative; NaN stays NaN.
double relativeRoot(double meanSquare, double mean);

}  // namespace glim
