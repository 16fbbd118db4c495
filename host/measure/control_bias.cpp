#include "host/measure/control_bias.hpp"

#include "host/measure/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace glim {
namespace {

constexpr std::size_t kMinPixels = 32;  // with fewer, of uneven radiance, intervals contain the truth too rarely

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
    if (chosen.size() < kMinPixels || !std::isfinite(chosenSum) || !(laterSum > *std::max_element(later.begin(), later.end()))) {
        return std::nullopt;
    }
    // The ratio without each pixel in turn: if few bright pixels make up the sums, this tells more than the spread of the differences.
    const double ratio = chosenSum / laterSum, n = static_cast<double>(chosen.size());
    std::vector<double> without;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        without.push_back((chosenSum - chosen[i]) / (laterSum - later[i]));
    }
    const double mean = std::accumulate(without.begin(), without.end(), 0.0) / n;
    double squares = 0.0;
    for (const double each : without) {
        squares += (each - mean) * (each - mean);
    }
    const double halfWidth = studentLimit(0.05, chosen.size() - 1) * std::sqrt(squares * (n - 1.0) / n);
    return ControlBias{chosen.size(), {ratio - 1.0, ratio - 1.0 - halfWidth, ratio - 1.0 + halfWidth}};
}

}  // namespace glim
