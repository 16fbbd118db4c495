// The transfer function of sRGB (IEC 61966-2-1), between values in [0, 1].
#pragma once

#include <cmath>

namespace glim {

inline double linearFromSrgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
inline double srgbFromLinear(double l) { return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055; }

}  // namespace glim
