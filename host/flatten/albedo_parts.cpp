#include "host/flatten/albedo_parts.hpp"

#include <algorithm>
#include <bit>
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

double rounded(double value) { return std::ldexp(std::round(std::ldexp(value, 22)), -22); }

double fifthPower(double x) { return x * x * x * x * x; }

uvec4 texelOf(const glm::dvec2& a, const glm::dvec2& b)
{
    const auto bits = [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); };
    return {bits(a.x), bits(a.y), bits(b.x), bits(b.y)};
}

void pushTexels(std::vector<uvec4>& table, const std::vector<glm::dvec2>& row)
{
    for (std::size_t i = 0; i < row.size(); ++i) {
        table.push_back(texelOf(row[i], row[std::min(i + 1, row.size() - 1)]));
    }
}

}  // namespace glim
