#include "host/measure/confidence.hpp"

#include <cmath>
#include <numbers>

namespace glim {
namespace {

// P(|T| <= t), a finite sum for whole degrees of freedom (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4).
double shareWithin(double t, std::size_t freedom)
{
    const double angle = std::atan(t / std::sqrt(static_cast<double>(freedom)));
    const double cosine = std::cos(angle);
    const bool odd = freedom % 2 == 1;
    double term = odd ? cosine : 1.0, sum = freedom == 1 ? 0.0 : term;
    for (std::size_t k = odd ? 3 : 2; k < freedom; k += 2) {
        term *= cosine * cosine * static_cast<double>(k - 1) / static_cast<double>(k);
        sum += term;
    }
    return odd ? 2.0 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

}  // namespace

double twoSidedLimit(double alpha)
{
    double below = 0.0, above = 40.0;  // erfc(40 / sqrt 2) is 0 in double
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (below + above);
        (std::erfc(middle / std::numbers::sqrt2) > alpha ? below : above) = middle;
    }
    return above;
}

double studentLimit(double alpha, std::size_t freedom)
{
    double below = 0.0, above = 1e7;  // P(|T| > 1e7) of one degree is 6e-8
    for (int step = 0; step < 100; ++step) {
        const double middle = 0.5 * (below + above);
        (1.0 - shareWithin(middle, freedom) > alpha ? below : above) = middle;
    }
    return above;
}

double sidakLevel(double alpha, std::size_t tests)
{
    return tests == 0 ? alpha : -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

}  // namespace glim
