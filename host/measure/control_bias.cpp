#include "host/measure/control_bias.hpp"

#include "host/measure/normal.hpp"

#include <cmath>
#include <vector>

namespace glim {
namespace {

constexpr std::size_t kLeastPixels = 16;  // fewer tell no spread

double meanOf(const PixelMoments& pixel)
{
    return (static_cast<double>(pixel.mean.r) + static_cast<double>(pixel.mean.g) + static_cast<double>(pixel.mean.b)) / 3.0;
}

}  // namespace

std::optional<ControlBias> estimateControlBias(const Film& film, const Film& control)
{
    std::vector<double> chosen, later;
    double chosenSum = 0.0, laterSum = 0.0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        if (control.pixels[i].count > 0 && film.pixels[i].count > 0) {
            chosen.push_back(meanOf(film.pixels[i]));
            later.push_back(meanOf(control.pixels[i]));
            chosenSum += chosen.back();
            laterSum += later.back();
        }
    }
    if (chosen.size() < kLeastPixels || laterSum <= 0.0) {
        return std::nullopt;
    }
    const double ratio = chosenSum / laterSum, n = static_cast<double>(chosen.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double difference = chosen[i] - ratio * later[i];
        squares += difference * difference;
    }
    const double reach = twoSidedLimit(0.05) * std::sqrt(squares * n / (n - 1.0)) / laterSum;
    return ControlBias{chosen.size(), {ratio - 1.0, ratio - 1.0 - reach, ratio - 1.0 + reach}};
}

}  // namespace glim
