#include "host/measure/error_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr std::uint32_t kTile = 16;
// Of the sums over the four directions the least is taken, which is up to 10 % low over the 256 pixels of a tile.
constexpr double kLeastOfFour = 1.15;
// A standard normal is smaller than this in 95 of 100 cases.
constexpr double kOneSided = 1.645;

// The sum over a part of the picture of what a pixel's second difference says about its squared error; and of its square.
struct TileSums {
    double value = 0.0, squares = 0.0, count = 0.0;
};

// Let the errors of a, b and c be independent, and s^2 the mean of their squares. Then (a - 2 b + c)^2 / 6 is s^2 on average, and more
// where the picture is curved.
double secondDifference(const Picture& picture, std::size_t pixel, std::size_t step)
{
    const glm::dvec3 difference =
        glm::dvec3(picture.radiance[pixel - step]) - 2.0 * glm::dvec3(picture.radiance[pixel]) + glm::dvec3(picture.radiance[pixel + step]);
    return glm::dot(difference, difference) / 18.0;
}

// The direction in which the tile differs least: along edges, where there are some.
TileSums sumTile(const Picture& picture, std::uint32_t left, std::uint32_t top)
{
    const std::size_t width = picture.width;
    TileSums least;
    least.value = std::numeric_limits<double>::infinity();
    for (const std::size_t step : {std::size_t{1}, width, width + 1, width - 1}) {
        TileSums sums;
        for (std::uint32_t y = top; y < std::min(top + kTile, picture.height - 1); ++y) {
            for (std::uint32_t x = left; x < std::min(left + kTile, picture.width - 1); ++x) {
                const double value = secondDifference(picture, y * width + x, step);
                sums.value += value;
                sums.squares += value * value;
                sums.count += 1.0;
            }
        }
        least = sums.value < least.value ? sums : least;
    }
    return least;
}

}  // namespace

std::optional<double> boundMse(const Picture& picture)
{
    const bool isSmall = picture.width < 3 || picture.height < 3;
    if (isSmall || !std::ranges::all_of(picture.radiance, [](const glm::vec3& value) { return isFinite(glm::dvec3(value)); })) {
        return std::nullopt;
    }
    TileSums all;
    for (std::uint32_t y = 1; y + 1 < picture.height; y += kTile) {
        for (std::uint32_t x = 1; x + 1 < picture.width; x += kTile) {
            const TileSums tile = sumTile(picture, x, y);
            all.value += tile.value;
            all.squares += tile.squares;
            all.count += tile.count;
        }
    }
    if (all.value == 0.0) {
        return 0.0;
    }
    // Second differences of neighbours have the correlations -2/3 and 1/6, their squares those squared: a sum has 1.94 times the variance
    // that it has of independent ones. Squares of normal numbers have a variance of 2/3 of their mean square. The sum is taken as
    // log-normal.
    const double deviation = std::sqrt(1.94 * 2.0 / 3.0 * all.squares) / all.value;
    return kLeastOfFour * all.value / all.count * std::exp(kOneSided * deviation);
}

}  // namespace glim
