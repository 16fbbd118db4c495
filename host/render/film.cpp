#include "host/render/film.hpp"

#include <algorithm>
#include <limits>

namespace glim {

PixelMoments foldMoments(const PixelMoments& a, const PixelMoments& b)
{
    if (a.count == 0) {
        return b;
    }
    if (b.count == 0) {
        return a;
    }
    PixelMoments sum{};
    sum.count = a.count + b.count;
    sum.blocks = a.blocks + b.blocks;
    const float share = static_cast<float>(b.count) / static_cast<float>(sum.count);
    const glm::vec3 delta = b.mean - a.mean;
    sum.mean = a.mean + delta * share;
    sum.squares = (a.squares + b.squares) + (delta * delta) * (static_cast<float>(a.count) * share);
    sum.alpha = a.alpha + (b.alpha - a.alpha) * share;
    sum.albedo = a.albedo + (b.albedo - a.albedo) * share;
    sum.normal = a.normal + (b.normal - a.normal) * share;
    sum.depth = std::min(a.depth, b.depth);
    sum.clamped = a.clamped + (b.clamped - a.clamped) * share;
    return sum;
}

void foldPage(Film& film, std::size_t begin, const std::vector<PixelMoments>& page)
{
    const auto pixels = film.pixels.begin() + static_cast<std::ptrdiff_t>(begin);
    std::transform(page.begin(), page.end(), pixels, pixels,
                   [](const PixelMoments& folded, const PixelMoments& known) { return foldMoments(known, folded); });
}

glm::vec3 varianceOfMean(const PixelMoments& moments)
{
    if (moments.blocks < 2) {
        return glm::vec3(std::numeric_limits<float>::quiet_NaN());
    }
    return moments.squares / (static_cast<float>(moments.blocks - 1) * static_cast<float>(moments.count));
}

}  // namespace glim
