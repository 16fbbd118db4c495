// How far a film is from the truth, as far as its own blocks of samples tell.
#pragma once

#include "host/measure/compare_images.hpp"
#include "host/measure/interval.hpp"

#include <cstddef>
#include <optional>

namespace glim {

struct ErrorEstimate {
    SquaredErrors errors;          // of this very film against the truth; biases are not among them
    Interval mse, relMse;
    double mean = 0.0;             // radiance over pixels and channels, W/(sr m^2)
    std::size_t pixelsOfHalf = 0;  // the fewest pixels that make up half of mse

    // Too few to tell how the next ones are: a lamp's rim in a small picture, or paths so rare and bright that most are missing.
    bool isOfFew() const { return pixelsOfHalf < 10 && errors.mse > 0.0; }
};

// Pixels of fewer than two blocks are left out; nothing if there are no others.
std::optional<ErrorEstimate> estimateError(const Film& film);

// The root of a mean square error, relative to the mean of what it is the error of.
double relativeRoot(double meanSquare, double mean);

}  // namespace glim
