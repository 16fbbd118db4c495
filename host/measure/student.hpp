// Limits for means of few values whose variance is estimated from them.
#pragma once

#include <cstddef>

namespace glim {

// The t with P(|T| > t) = alpha for Student's distribution with `freedom` >= 1 degrees, for 1e-6 <= alpha < 1.
double studentLimit(double alpha, std::size_t freedom);

}  // namespace glim
