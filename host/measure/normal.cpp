#include "host/measure/normal.hpp"

#include <cmath>
#include <numbers>

namespace glim {

double twoSidedLimit(double alpha)
{
    double below = 0.0, above = 40.0;  // erfc(40 / sqrt 2) is 0 in double
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (below + above);
        (std::erfc(middle / std::numbers::sqrt2) > alpha ? below : above) = middle;
    }
    return above;
}

double sidakLevel(double alpha, std::size_t tests)
{
    return tests == 0 ? alpha : -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

}  // namespace glim
