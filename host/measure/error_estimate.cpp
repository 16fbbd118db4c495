#include "host/measure/error_estimate.hpp"

#include "host/measure/confidence.hpp"
#include "host/render/robust_radiance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

namespace glim {
namespace {

// A pixel's part of the sum, the mean of its channels, and the number of blocks it is known from.
struct Part {
    double value;
    double blocks;
};

// Let s^2 be the variance of a pixel's mean, and block means be normal. The mean's squared error has the variance 2 s^4. An estimate of
// s^2 from K blocks has the variance 2 s^4 / (K - 1), and its square is (K + 1) / (K - 1) s^4 on average. So the variance of the
// difference of the two sums is the sum of 2 K / (K + 1) times the squared estimates. Channels count as fully correlated. The interval is
// that of the logarithm, since errors are positive.
Interval intervalOf(const std::vector<Part>& parts)
{
    double sum = 0.0, variance = 0.0;
    for (const Part& part : parts) {
        sum += part.value;
        variance += 2.0 * part.blocks / (part.blocks + 1.0) * part.value * part.value;
    }
    if (sum == 0.0) {
        return {};
    }
    const double factor = std::exp(twoSidedLimit(0.05) * std::sqrt(variance) / sum);
    const double value = sum / static_cast<double>(parts.size());
    return {value, value / factor, value * factor};
}

std::size_t countOfHalf(std::vector<Part> parts)
{
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.value > b.value; });
    const double half = 0.5 * std::accumulate(parts.begin(), parts.end(), 0.0, [](double sum, const Part& p) { return sum + p.value; });
    std::size_t count = 0;
    for (double sum = 0.0; count < parts.size() && sum < half; ++count) {
        sum += parts[count].value;
    }
    return count;
}

// The variance of each channel of pixel i, times a weight.
std::vector<Part> partsOf(const Film& film, const std::function<double(std::size_t, int)>& weight)
{
    std::vector<Part> parts;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelMoments pixel = shownPixel(film, i);
        if (pixel.blocks >= 2) {
            const glm::vec3 variance = computeVarianceOfMean(pixel);
            double sum = 0.0;
            for (int c = 0; c < 3; ++c) {
                const double square = static_cast<double>(variance[c]);
                sum += square * weight(i, c);
            }
            parts.push_back({sum / 3.0, static_cast<double>(pixel.blocks)});
        }
    }
    return parts;
}

}  // namespace

std::optional<ErrorEstimate> estimateError(const Film& film)
{
    const Picture picture = makePicture(film);
    const std::vector<glm::dvec3> likely = robustRadiance(picture.width, picture.height, picture.radiance, picture.variance);
    const auto errors = estimateErrors(picture, likely);
    if (!errors) {
        return std::nullopt;
    }
    const double epsilon = relativeEpsilon(picture);
    const std::vector<Part> parts = partsOf(film, [](std::size_t, int) { return 1.0; });
    ErrorEstimate estimate;
    estimate.errors = *errors;
    estimate.mse = intervalOf(parts);
    estimate.relMse = intervalOf(partsOf(film, [&](std::size_t i, int c) { return 1.0 / (likely[i][c] * likely[i][c] + epsilon); }));
    estimate.mean = meanRadiance(picture);
    estimate.pixelsOfHalf = countOfHalf(parts);
    const bool isKnown = std::isfinite(estimate.mse.high) && std::isfinite(estimate.relMse.high);
    return isKnown ? std::optional(estimate) : std::nullopt;
}

double relativeRoot(double meanSquare, double mean) { return meanSquare <= 0.0 ? 0.0 : std::sqrt(meanSquare) / mean; }

}  // namespace glim
