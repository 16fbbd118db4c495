#include "host/image/shrink_image.hpp"

#include "host/image/srgb.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// What a new texel covers along one axis: old ones from `first` on, each with its share.
struct Cover {
    std::uint32_t first = 0;
    std::vector<float> shares;
};

std::vector<Cover> coverAxis(std::uint32_t from, std::uint32_t to)
{
    std::vector<Cover> covers(to);
    for (std::uint32_t i = 0; i < to; ++i) {
        const double begin = static_cast<double>(i) * from / to, end = static_cast<double>(i + 1) * from / to;
        covers[i].first = static_cast<std::uint32_t>(begin);
        for (std::uint32_t x = covers[i].first; x < from && static_cast<double>(x) < end; ++x) {
            const double share = std::min(end, x + 1.0) - std::max(begin, static_cast<double>(x));
            covers[i].shares.push_back(static_cast<float>(share / (end - begin)));
        }
    }
    return covers;
}

template <class Channel>
std::vector<Channel> shrink(const std::vector<Channel>& texels, std::uint32_t width, const std::vector<Cover>& columns,
                            const std::vector<Cover>& rows, bool srgb)
{
    constexpr std::size_t kMax = sizeof(Channel) == 1 ? 255 : 65535;
    std::vector<float> linear(kMax + 1), plain(kMax + 1);
    for (std::size_t i = 0; i <= kMax; ++i) {
        plain[i] = static_cast<float>(i) / kMax;
        linear[i] = srgb ? static_cast<float>(linearFromSrgb(static_cast<double>(i) / kMax)) : plain[i];
    }
    std::vector<Channel> small;
    small.reserve(columns.size() * rows.size() * 4);
    for (const Cover& row : rows) {
        for (const Cover& column : columns) {
            float sums[4] = {};
            for (std::size_t y = 0; y < row.shares.size(); ++y) {
                for (std::size_t x = 0; x < column.shares.size(); ++x) {
                    const Channel* t = &texels[4 * ((row.first + y) * width + column.first + x)];
                    const float share = row.shares[y] * column.shares[x];
                    for (std::size_t c = 0; c < 4; ++c) {
                        sums[c] += share * (c < 3 ? linear : plain)[t[c]];
                    }
                }
            }
            for (std::size_t c = 0; c < 4; ++c) {
                const double mean = std::clamp(static_cast<double>(sums[c]), 0.0, 1.0);
                small.push_back(static_cast<Channel>(std::lround((srgb && c < 3 ? srgbFromLinear(mean) : mean) * kMax)));
            }
        }
    }
    return small;
}

}  // namespace

DecodedImage shrinkImage(DecodedImage image, std::uint32_t maxSide, bool srgb)
{
    std::uint32_t width = image.width, height = image.height;
    while (std::max(width, height) > maxSide) {
        width = std::max(width / 2, 1U);
        height = std::max(height / 2, 1U);
    }
    if (width == image.width && height == image.height) {
        return image;
    }
    const std::vector<Cover> columns = coverAxis(image.width, width), rows = coverAxis(image.height, height);
    if (image.rgba16.empty()) {
        image.rgba8 = shrink(image.rgba8, image.width, columns, rows, srgb);
    } else {
        image.rgba16 = shrink(image.rgba16, image.width, columns, rows, srgb);
    }
    image.width = width;
    image.height = height;
    return image;
}

}  // namespace glim
