#include "host/flatten/gauss_rule.hpp"

#include <cmath>
#include <numbers>

namespace glim {

// By Newton's iteration on the polynomial's zeros.
GaussRule::GaussRule(std::size_t count)
{
    for (std::size_t i = 0; i < count; ++i) {
        double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (static_cast<double>(count) + 0.5)), slope = 1.0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            double before = 1.0, here = x;
            for (std::size_t n = 2; n <= count; ++n) {
                const auto k = static_cast<double>(n);
                const double next = ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k;
                before = here;
                here = next;
            }
            slope = static_cast<double>(count) * (x * here - before) / (x * x - 1.0);
            const double step = here / slope;
            x -= step;
            if (std::abs(step) < 1e-15) {
                break;
            }
        }
        nodes.push_back(x);
        weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
    }
}

}  // namespace glim
