// The bound of the error holds one-sidedly, and is not far from the error of smooth pictures.
#include "host/measure/error_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace glim {
namespace {

using Truth = std::function<double(double, double)>;  // of the place, from 0 to 1
using Draw = std::function<double(std::mt19937&)>;    // an error of mean 0 and variance 1

struct BoundTrials {
    double holds = 0.0;  // share of pictures
    double ratio = 0.0;  // of the root of the bound to that of the mean squared error, mean
};

BoundTrials tryBound(std::uint32_t side, const Truth& truth, const Draw& draw, double deviation)
{
    constexpr int kNoisyPictures = 400;
    std::mt19937 random(7);
    BoundTrials trials;
    for (int i = 0; i < kNoisyPictures; ++i) {
        Picture picture{side, side, {}, {}};
        double mse = 0.0;
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; ++x) {
                const double error = deviation * draw(random);  // grey, as most noise is
                picture.radiance.emplace_back(static_cast<float>(truth(1.0 * x / side, 1.0 * y / side) + error));
                mse += error * error / (side * side);
            }
        }
        const double bound = boundMse(picture).value();
        trials.holds += bound >= mse ? 1.0 / kNoisyPictures : 0.0;
        trials.ratio += std::sqrt(bound / mse) / kNoisyPictures;
    }
    return trials;
}

double drawNormal(std::mt19937& random) { return std::normal_distribution<double>()(random); }
double drawExponential(std::mt19937& random) { return std::exponential_distribution<double>()(random) - 1.0; }

double flat(double, double) { return 1.0; }
double slope(double x, double y) { return 1.0 + x + 2.0 * y; }
double edge(double x, double y) { return x + 0.3 * y > 0.6 ? 2.0 : 0.2; }
double waves(double x, double y) { return 1.0 + 0.5 * std::sin(90.0 * x) * std::cos(70.0 * y); }

// 95 % are due; four standard deviations of the share of 400 below that is 90.6 %.
TEST(ErrorBound, HoldsInNineteenOfTwentyPictures)
{
    for (const std::uint32_t side : {16U, 40U, 100U}) {
        for (const Truth& truth : {Truth(flat), Truth(slope), Truth(edge), Truth(waves)}) {
            for (const Draw& draw : {Draw(drawNormal), Draw(drawExponential)}) {
                for (const double deviation : {0.01, 0.3}) {
                    EXPECT_GE(tryBound(side, truth, draw, deviation).holds, 0.906) << side << " " << deviation;
                }
            }
        }
    }
}

TEST(ErrorBound, IsNearTheErrorOfSmoothPictures)
{
    for (const Draw& draw : {Draw(drawNormal), Draw(drawExponential)}) {
        EXPECT_LT(tryBound(100, slope, draw, 0.3).ratio, 1.2);
        EXPECT_LT(tryBound(40, slope, draw, 0.3).ratio, 1.35);
        EXPECT_LT(tryBound(100, edge, draw, 0.3).ratio, 1.4);
    }
}

TEST(ErrorBound, WithoutNeighboursThereIsNone)
{
    EXPECT_FALSE(boundMse(Picture{2, 9, std::vector<glm::vec3>(18), {}}));
    Picture picture{3, 3, std::vector<glm::vec3>(9, glm::vec3(1.0F)), {}};
    EXPECT_EQ(boundMse(picture), 0.0);
    picture.radiance[8].g = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(boundMse(picture));
}

}  // namespace
}  // namespace glim
