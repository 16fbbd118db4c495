// Limits for normally distributed test statistics.
#pragma once

#include <cstddef>

namespace glim {

// The z with P(|N(0,1)| > z) = alpha, for 0 < alpha < 1.
double twoSidedLimit(double alpha);

// Sidak: the level of each of `tests` independent tests at which their family has level alpha.
double sidakLevel(double alpha, std::size_t tests);

}  // namespace glim
