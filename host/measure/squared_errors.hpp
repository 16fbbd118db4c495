// Errors of which each term is a squared difference, and what is left of them without their largest terms.
#pragma once

#include <cstddef>
#include <vector>

namespace glim {

struct SquaredErrors {
    double mse = 0.0;             // mean (x-r)^2
    double relMse = 0.0;          // mean (x-r)^2 / (r^2 + eps), eps = .01 mean(r)^2: the scene's brightness cancels
    double relMseAbsolute = 0.0;  // the same with eps = .01, as published comparisons use (Rousselle et al. 2011)
};

// Each of the three by its own order of the pixels: which terms are largest depends on their weight. Few bright pixels may
// make most of an error; trimmed figures stand beside the full ones, which alone are expected errors.
struct TrimmedErrors {
    std::size_t dropped = 0;  // pixels: .1 %, rounded down
    SquaredErrors kept;       // means over the other pixels
    SquaredErrors share;      // of each sum, what the dropped pixels make up; 0 where there is no error
};

// `pixels`: the mean over channels of each pixel's terms.
TrimmedErrors trimErrors(const std::vector<SquaredErrors>& pixels);

}  // namespace glim
