// H24: --roulette in a closed room of albedo a whose walls emit 1, where a path's value is known at every length.
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr double kSurvival = 0.7;

Film renderWithRoulette(double albedo, Roulette roulette, std::uint32_t bounces, std::uint32_t spp, std::uint32_t side = 64)
{
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(glm::vec3(static_cast<float>(albedo)), glm::vec3(1.0F)), true)
        .perspective({0.3F, 0.2F, 0.6F}, {-1, -0.5F, -1}, 1.0F);
    RenderSettings settings = squareSettings(side, spp);
    settings.sampler = Sampler::Independent;
    settings.course.direct = DirectLight::Bsdf;
    settings.bounces = bounces;
    settings.course.roulette = roulette;
    settings.course.survival = static_cast<float>(kSurvival);
    return renderScene(builder.scene(), settings);
}

// E X^p of a path's value X under the fixed roulette: with q^(m-1) it reaches hit m >= 1, where it collects a^m / q^(m-1).
double moment(double a, std::uint32_t bounces, int p)
{
    double expected = 0.0, value = 1.0, reach = 1.0;
    for (std::uint32_t m = 1; m <= bounces; ++m) {
        value += std::pow(a, m) / std::pow(kSurvival, m - 1);
        const double ends = m == bounces ? reach : reach * (1.0 - kSurvival);
        expected += ends * std::pow(value, p);
        reach *= kSurvival;
    }
    return expected;
}

double variance(double a, std::uint32_t bounces) { return moment(a, bounces, 2) - std::pow(moment(a, bounces, 1), 2); }

double truth(double a, std::uint32_t bounces) { return (1.0 - std::pow(a, bounces + 1.0)) / (1.0 - a); }

TEST(RoulettePictureTest, NoneFollowsEveryPathToTheEnd)
{
    expectEverywhere(renderWithRoulette(0.8, Roulette::None, 30, 4), glm::dvec3(truth(0.8, 30)), 31);
}

TEST(RoulettePictureTest, AllHaveTheSameMeanWhereTheVarianceExists)
{
    for (const double a : {0.5, 0.8}) {
        const double z = scoreLimit(200);
        for (const Roulette roulette : {Roulette::Throughput, Roulette::Fixed}) {
            const MeanEstimate mean = meanOf(renderWithRoulette(a, roulette, 200, samplesFor(64)));
            const double samples = 64.0 * 64.0 * samplesFor(64);
            // The fixed roulette's estimate of its own error is too noisy: the formula gives the error.
            const double error = roulette == Roulette::Fixed ? std::sqrt(variance(a, 200) / samples) : mean.standardError.g;
            EXPECT_NEAR(mean.mean.g, truth(a, 200), z * error);
            std::printf("albedo %.1f, %s: relative error %.1e +- %.1e\n", a, roulette == Roulette::Fixed ? "fixed:0.7" : "throughput",
                        mean.mean.g / truth(a, 200) - 1.0, error / truth(a, 200));
        }
    }
}

// The variance that is measured is the formula's, and that grows without limit where a^2 >= q, by a^2/q per bounce.
TEST(RoulettePictureTest, FixedHasInfiniteVarianceAboveItsLimit)
{
    for (const auto& [a, bounces] : {std::pair{0.6, 12U}, {0.8, 12U}, {0.9, 6U}, {0.9, 12U}}) {
        constexpr std::uint32_t kSamples = 256;
        double sum = 0.0;
        const Film film = renderWithRoulette(a, Roulette::Fixed, bounces, kSamples);
        for (const PixelMoments& pixel : film.pixels) {
            sum += static_cast<double>(computeVarianceOfMean(pixel).g) * kSamples;
        }
        const double measured = sum / static_cast<double>(film.pixels.size()), expected = variance(a, bounces);
        // Squared error of a variance from n samples in blocks: fourth central moment / n + variance^2 * (2 / blocks).
        const double mean = moment(a, bounces, 1);
        const double fourth =
            moment(a, bounces, 4) - 4 * mean * moment(a, bounces, 3) + 6 * mean * mean * moment(a, bounces, 2) - 3 * std::pow(mean, 4);
        const double n = 64.0 * 64.0 * kSamples;
        const double error = std::sqrt((fourth - expected * expected) / n + expected * expected * 2.0 * kBlockSamples / n);
        EXPECT_NEAR(measured, expected, 5.0 * error) << "albedo " << a;
        std::printf(
            "albedo %.1f: variance of a sample after %u bounces %.4g, formula %.4g +- %.2g; after 100 %.4g, "
            "after 200 %.4g\n",
            a, bounces, measured, expected, error, variance(a, 100), variance(a, 200));
        // The limit of the formula itself.
        const double growth = variance(a, 200) / variance(a, 100);
        EXPECT_EQ(growth < 1.001, a * a < kSurvival);
        EXPECT_EQ(growth > 1e5, a * a > kSurvival);
    }
    EXPECT_NEAR(std::sqrt(kSurvival), 0.837, 5e-4);
}

// The truth is 1 / (1 - a) = 100. By throughput a path goes on for certain until that is 1/3, after 110 bounces; each further bounce then
// adds 1/3, and their number is geometric: a path's value has the deviation sqrt(a) / (1 - a) / 3 = 33.2.
TEST(RoulettePictureTest, H24H25RoomOfAlbedo99Percent)
{
    constexpr double kAlbedo = 0.99, kDeviation = 99.5 / 3.0;
    constexpr std::uint32_t kSide = 16, kBounces = 3000;  // 8e-14 of the light is beyond them
    constexpr std::size_t kRays = 210;                    // of a path
    const auto spp = static_cast<std::uint32_t>(hardTrials(kSide * kSide * samplesFor(64, 16), kRays) / (kSide * kSide));
    const double paths = 1.0 * kSide * kSide * spp, z = scoreLimit(200);
    const MeanEstimate ours = meanOf(renderWithRoulette(kAlbedo, Roulette::Throughput, kBounces, spp, kSide));
    const MeanEstimate fixed = meanOf(renderWithRoulette(kAlbedo, Roulette::Fixed, kBounces, spp, kSide));
    const double deviation = ours.standardError.g * std::sqrt(paths), error = kDeviation / std::sqrt(paths);
    printHardCase("H24", "closed room of albedo .99", paths,
                  "mean " + figure(ours.mean.g) + " +- " + figure(error) + " of 100, deviation " + figure(deviation),
                  "fixed:0.7: mean " + figure(fixed.mean.g));
    EXPECT_NEAR(ours.mean.g, 100.0, z * error);
    EXPECT_GT(std::abs(fixed.mean.g - 100.0), z * error);
    // Squared error of an exponential's variance from n values: (kurtosis 9 - 1) / n, and 2 / (blocks - pixels) for the variance within
    // blocks. Each pixel has one block more than whole ones, since the first is two halves.
    const double spread = std::sqrt(8.0 / paths + 2.0 * kBlockSamples / paths);
    EXPECT_NEAR(deviation * deviation / (kDeviation * kDeviation), 1.0, 0.05 + z * spread);
}

}  // namespace
}  // namespace glim
