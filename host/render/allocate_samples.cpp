#include "host/render/allocate_samples.hpp"

#include "host/render/robust_radiance.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glim {
namespace {

constexpr int kRadius = 3;  // radius of the neighbourhood: 7x7

// The epsilon of relMSE, which is added to squared radiance: a relative error says nothing about black pixels.
double computeEpsilon(const Film& film)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : shownPixels(film)) {
        sum += static_cast<double>(pixel.mean.r + pixel.mean.g + pixel.mean.b) / 3.0;
    }
    const double mean = sum / static_cast<double>(film.pixels.size());
    return 0.01 * mean * mean;
}

// The variance of one sample, estimated from block means: the mean over channels, each divided by its `scale`. Negative if it is unknown
// or exceeds a float.
double computeVarianceOfSample(const PixelMoments& pixel, const glm::dvec3& scale)
{
    if (pixel.blocks < 2) {
        return -1.0;
    }
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double square = static_cast<double>(pixel.squares[c]);
        sum += square > 0.0 ? square / scale[c] : square;
    }
    return std::isfinite(sum) ? sum / (3.0 * (pixel.blocks - 1.0)) : -1.0;
}

// The mean over the neighbours whose variance is known.
double meanAround(const std::vector<double>& variances, int width, int height, int x, int y)
{
    double sum = 0.0;
    int known = 0;
    for (int v = std::max(0, y - kRadius); v <= std::min(height - 1, y + kRadius); ++v) {
        for (int u = std::max(0, x - kRadius); u <= std::min(width - 1, x + kRadius); ++u) {
            const double variance = variances[static_cast<std::size_t>(v * width + u)];
            const bool self = u == x && v == y;
            if (!self && variance >= 0.0) {
                sum += variance;
                ++known;
            }
        }
    }
    return known > 0 ? sum / known : 0.0;
}

// Samples still missing if pixels should have `scale` times their shares.
double missing(const std::vector<double>& shares, const std::vector<std::uint32_t>& samples, double scale)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        sum += std::max(0.0, scale * shares[i] - samples[i]);
    }
    return sum;
}

}  // namespace

std::vector<double> computeShares(const Film& film, SquaredError error)
{
    std::vector<glm::dvec3> scales(film.pixels.size(), glm::dvec3(1.0));
    if (error == SquaredError::Relative) {
        const std::vector<glm::dvec3> likely = robustRadiance(film);
        std::transform(likely.begin(), likely.end(), scales.begin(),
                       [epsilon = computeEpsilon(film)](const glm::dvec3& radiance) { return radiance * radiance + epsilon; });
    }
    std::vector<double> variances(film.pixels.size()), shares(film.pixels.size());
    std::transform(film.pixels.begin(), film.pixels.end(), scales.begin(), variances.begin(), computeVarianceOfSample);
    const int width = static_cast<int>(film.width), height = static_cast<int>(film.height);
    for (int y = 0, i = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x, ++i) {
            shares[static_cast<std::size_t>(i)] = std::sqrt(meanAround(variances, width, height, x, y));
        }
    }
    const double mean = std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
    for (double& share : shares) {
        share = mean > 0.0 ? share / mean : 1.0;
    }
    return shares;
}

std::vector<std::uint32_t> allocateBlocks(const std::vector<double>& shares, const std::vector<std::uint32_t>& samples, double meanSamples)
{
    const double all = meanSamples * static_cast<double>(shares.size());
    const double more = std::max(0.0, all - std::accumulate(samples.begin(), samples.end(), 0.0));
    // No pixel loses samples that it has, so the others get less than their share of `all`. Bisection to one part in 2^50.
    double low = 0.0, high = all / std::accumulate(shares.begin(), shares.end(), 0.0);
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (missing(shares, samples, middle) < more ? low : high) = middle;
    }
    std::vector<std::uint32_t> blocks(shares.size());
    double wanted = 0.0, given = 0.0;  // rounding errors carry over to the next pixel
    for (std::size_t i = 0; i < shares.size(); ++i) {
        wanted += std::max(0.0, low * shares[i] - samples[i]) / kBlockSamples;
        blocks[i] = static_cast<std::uint32_t>(std::max(0.0, std::round(wanted - given)));
        given += blocks[i];
    }
    return blocks;
}

}  // namespace glim
