#include "host/image/heat_color.hpp"

#include <algorithm>
#include <cmath>

namespace glim {

Rgb8 heatColor(double value)
{
    if (std::isnan(value)) {
        return kMagenta;
    }
    constexpr double kStops[][3] = {{0, 0, 255}, {0, 255, 255}, {0, 255, 0}, {255, 255, 0}, {255, 0, 0}};
    constexpr std::size_t kLast = std::size(kStops) - 1;
    const double place = std::clamp(value, 0.0, 1.0) * kLast;
    const std::size_t before = std::min(static_cast<std::size_t>(place), kLast - 1);
    Rgb8 color{};
    for (std::size_t c = 0; c < 3; ++c) {
        color[c] = static_cast<std::uint8_t>(
            std::lround(std::lerp(kStops[before][c], kStops[before + 1][c], place - static_cast<double>(before))));
    }
    return color;
}

Rgb8 differenceColor(double value)
{
    constexpr double kWhite = 255.0, kBlue[] = {0, 40, 200}, kRed[] = {200, 0, 0};
    const double(&end)[3] = value < 0 ? kBlue : kRed;
    const double share = std::min(std::abs(value), 1.0);
    Rgb8 color{};
    for (std::size_t c = 0; c < 3; ++c) {
        color[c] = static_cast<std::uint8_t>(std::lround(std::lerp(kWhite, end[c], share)));
    }
    return color;
}

}  // namespace glim
