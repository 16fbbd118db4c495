#include "host/render/composite.hpp"

#include "shaders/shared/composite.h"
#include "shaders/shared/luminance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {

std::vector<PixelMoments> pictureOf(const Film& film)
{
    std::vector<PixelMoments> pixels = shownPixels(film);
    for (std::size_t i = 0; i < film.catcher.size(); ++i) {
        pixels[i] = compositePixel(pixels[i], film.catcher[i]);
    }
    return pixels;
}

double computeAlphaError(const PixelMoments& pixel, const CatcherMoments& catcher)
{
    const double without = computeLuminance(glm::dvec3(catcher.without));
    if (pixel.blocks < 2) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (!(without > 0.0)) {
        return 0.0;
    }
    // The ratio's error is that of L_1 - r L_0, over L_0, and cov(a, b) = (var a + var b - var(a - b)) / 2.
    const double r = computeClearness(catcher), with2 = catcher.squares.x, without2 = catcher.squares.y, difference2 = catcher.squares.z;
    const double squares = with2 + r * r * without2 - r * (with2 + without2 - difference2);
    const double variance = std::max(squares, 0.0) / ((pixel.blocks - 1.0) * catcher.count);
    return static_cast<double>(catcher.share) * std::sqrt(variance) / without;
}

std::optional<double> computeAlphaRmse(const Film& film)
{
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < film.catcher.size(); ++i) {
        if (film.catcher[i].share > 0.0F) {
            const double error = computeAlphaError(film.pixels[i], film.catcher[i]);
            sum += error * error;
            count += 1.0;
        }
    }
    return count > 0.0 && std::isfinite(sum) ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

}  // namespace glim
