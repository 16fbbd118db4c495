// Sums over rectangles of an image in constant time, for the footprints of many triangles. Crow, "Summed-Area Tables for
// Texture Mapping", 1984.
#pragma once

#include "host/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace glim {

// The rectangle of the texture that some texture coordinates span.
struct UvBox {
    glm::vec2 low, high;
};

class BoxSums {
public:
    // `value` of each texel (x, y), a whole number so that sums are exact.
    BoxSums(std::uint32_t width, std::uint32_t height, const std::function<std::uint32_t(std::uint32_t, std::uint32_t)>& value)
        : width_(width),
          height_(height),
          sums_(std::size_t{width + 1} * (height + 1), 0)
    {
        for (std::uint32_t y = 0; y < height; ++y) {
            std::uint64_t row = 0;
            for (std::uint32_t x = 0; x < width; ++x) {
                row += value(x, y);
                at(x + 1, y + 1) = at(x + 1, y) + row;
            }
        }
    }

    // The mean over all texels that a bilinear look-up within the box can touch, and one more on each side.
    double mean(const UvBox& box, const Texture& texture) const
    {
        const Span x = computeSpan(box.low.x, box.high.x, width_, texture.wrapS),
                   y = computeSpan(box.low.y, box.high.y, height_, texture.wrapT);
        std::uint64_t sum = 0;
        for (const Range& across : x.ranges) {
            for (const Range& down : y.ranges) {
                sum += at(across.end, down.end) - at(across.begin, down.end) - at(across.end, down.begin) + at(across.begin, down.begin);
            }
        }
        return static_cast<double>(sum) / (static_cast<double>(x.count()) * static_cast<double>(y.count()));
    }

private:
    struct Range {
        std::uint32_t begin = 0, end = 0;
    };
    // What an interval covers of one axis: up to two ranges, since it may wrap around.
    struct Span {
        Range ranges[2];
        std::uint64_t count() const { return std::uint64_t{ranges[0].end} - ranges[0].begin + ranges[1].end - ranges[1].begin; }
    };

    std::uint64_t& at(std::uint32_t x, std::uint32_t y) { return sums_[std::size_t{y} * (width_ + 1) + x]; }
    std::uint64_t at(std::uint32_t x, std::uint32_t y) const { return sums_[std::size_t{y} * (width_ + 1) + x]; }

    static Span computeSpan(float low, float high, std::uint32_t size, Wrap wrap)
    {
        const double first = std::floor(static_cast<double>(low) * size - 0.5) - 1.0,
                     last = std::floor(static_cast<double>(high) * size - 0.5) + 2.0;
        const Span whole{{{0, size}, {}}};
        if (!(last - first < size)) {
            return whole;  // also where a coordinate is not finite
        }
        if (wrap == Wrap::Clamp) {
            const auto clamp = [size](double texel) { return static_cast<std::uint32_t>(std::clamp(texel, 0.0, size - 1.0)); };
            return {{{clamp(first), clamp(last) + 1}, {}}};
        }
        const double begin = first - std::floor(first / size) * size, end = begin + (last - first) + 1.0;
        if (wrap == Wrap::Mirrored) {
            return end <= size && std::fmod(std::floor(first / size), 2.0) == 0.0
                       ? Span{{{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}, {}}}
                       : whole;
        }
        return end <= size ? Span{{{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}, {}}}
                           : Span{{{static_cast<std::uint32_t>(begin), size}, {0, static_cast<std::uint32_t>(end - size)}}};
    }

    std::uint32_t width_, height_;
    std::vector<std::uint64_t> sums_;
};

// The box of three corners' texture coordinates in the image.
inline UvBox computeUvBox(const Texture& texture, const glm::vec2 (&uv)[3])
{
    UvBox box{glm::vec2(std::numeric_limits<float>::infinity()), glm::vec2(-std::numeric_limits<float>::infinity())};
    for (const glm::vec2& corner : uv) {
        const glm::vec2 at(glm::dot(texture.rowU, glm::vec3(corner, 1.0F)), glm::dot(texture.rowV, glm::vec3(corner, 1.0F)));
        const bool finite = std::isfinite(at.x) && std::isfinite(at.y);
        box.low = finite ? glm::min(box.low, at) : glm::vec2(-std::numeric_limits<float>::infinity());
        box.high = finite ? glm::max(box.high, at) : glm::vec2(std::numeric_limits<float>::infinity());
    }
    return box;
}

}  // namespace glim
