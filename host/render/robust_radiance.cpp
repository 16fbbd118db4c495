#include "host/render/robust_radiance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glim {
namespace {

constexpr double kDeviations = 2.0;

struct Plane {
    std::int64_t width, height;
    const std::vector<glm::vec3>& radiance;

    std::optional<double> meanAround(std::int64_t x, std::int64_t y, int channel) const
    {
        double sum = 0.0;
        int known = 0;
        for (std::int64_t v = std::max<std::int64_t>(0, y - 1); v <= std::min(height - 1, y + 1); ++v) {
            for (std::int64_t u = std::max<std::int64_t>(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
                const float value = radiance[static_cast<std::size_t>(v * width + u)][channel];
                if ((u != x || v != y) && std::isfinite(value)) {
                    sum += static_cast<double>(value);
                    ++known;
                }
            }
        }
        return known > 0 ? std::optional(sum / known) : std::nullopt;
    }
};

}  // namespace

std::vector<glm::dvec3> robustRadiance(std::uint32_t width, std::uint32_t height, const std::vector<glm::vec3>& radiance,
                                       const std::vector<glm::vec3>& variance)
{
    const Plane plane{width, height, radiance};
    std::vector<glm::dvec3> likely(radiance.begin(), radiance.end());
    for (std::size_t i = 0; i < variance.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double square = static_cast<double>(variance[i][c]);
            if (!(square > 0.0)) {
                continue;
            }
            const auto around = plane.meanAround(static_cast<std::int64_t>(i % width), static_cast<std::int64_t>(i / width), c);
            if (around && likely[i][c] > *around && likely[i][c] - *around < kDeviations * std::sqrt(square)) {
                likely[i][c] = *around;
            }
        }
    }
    return likely;
}

std::vector<glm::dvec3> robustRadiance(const Film& film)
{
    std::vector<glm::vec3> radiance, variance;
    for (const PixelMoments& pixel : shownPixels(film)) {
        radiance.push_back(pixel.mean);
        variance.push_back(computeVarianceOfMean(pixel));
    }
    return robustRadiance(film.width, film.height, radiance, variance);
}

}  // namespace glim
