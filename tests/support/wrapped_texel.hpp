// Which texel a wrapped index stands for, by the table of OpenGL 4.6, section 8.14.2: independent of the shaders, which wrap coordinates.
#pragma once

#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glim::test {

inline std::uint32_t wrappedTexel(double index, std::uint32_t size, std::uint32_t wrap)
{
    const double n = size;
    const auto modulo = [](double a, double b) { return a - b * std::floor(a / b); };
    if (wrap == kRepeat) {
        return static_cast<std::uint32_t>(modulo(index, n));
    }
    if (wrap == kMirrored) {
        const double place = modulo(index, 2.0 * n) - n;
        return static_cast<std::uint32_t>(n - 1.0 - (place >= 0.0 ? place : -(1.0 + place)));
    }
    return static_cast<std::uint32_t>(std::clamp(index, 0.0, n - 1.0));
}

// IEC 61966-2-1.
inline double linearFromSrgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

}  // namespace glim::test
