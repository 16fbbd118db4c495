// Intervals, and limits of test statistics.
#pragma once

#include <cstddef>

namespace glim {

// A figure and how far it may be from the truth.
struct Interval {
    double value = 0.0;
    double low = 0.0, high = 0.0;  // 95 %; NaN where there is none
};

// The z with P(|N(0,1)| > z) = alpha, for 0 < alpha < 1.
double twoSidedLimit(double alpha);

// The t with P(|T| > t) = alpha for Student's distribution with `freedom` >= 1 degrees, for 1e-6 <= alpha < 1. For means of
// few values whose variance is estimated from them.
double studentLimit(double alpha, std::size_t freedom);

// Sidak: the level of each of `tests` independent tests at which their family has level alpha.
double sidakLevel(double alpha, std::size_t tests);

}  // namespace glim
