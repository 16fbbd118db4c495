// H30: the variance that a picture reports is that of pictures with other seeds, and the interval of its error holds the error.
#include "host/measure/error_estimate.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/measure/compare_images.hpp"
#include "host/measure/error_bound.hpp"
#include "host/render/learn_guide.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "shaders/shared/limits.h"
#include "tests/harness/statistics.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/single_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 24, kSamples = 2 * kFirstBlockSamples, kSeeds = 32;

// A scene with caustics. The picture shows lamp and balls.
Scene glassRoom() { return loadGltf(GLIM_SOURCE_DIR "/scenes/cornell_mirror_glass.gltf"); }

// Another one. The picture shows only what they fall on: neither the lamp's rim nor its mirror image makes up the error.
Scene floorUnderGlass()
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F, 0.6F, 0.5F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(8.0F, 7.0F, 5.0F));
    builder.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, white)
        .quad({glm::vec3(-2, -1, -2), {2, -1, -2}, {2, 2, -2}, {-2, 2, -2}}, white)
        .quad({glm::vec3(-0.5F, 1.5F, -0.5F), {0.5F, 1.5F, -0.5F}, {0.5F, 1.5F, 0.5F}, {-0.5F, 1.5F, 0.5F}}, lamp)
        .sphere({0.4F, 0.2F, 0.0F}, 0.4F, builder.glass(1.5F))
        .sphere({-0.6F, 0.3F, -0.3F}, 0.4F, builder.mirror(glm::vec3(0.9F)))
        .perspective({0.0F, -0.5F, 1.8F}, {0.0F, -1.0F, 0.0F}, 0.4F);
    return builder.scene();
}

struct Ways {
    Scene (*scene)();  // one whose error many pixels make up
    Sampler sampler;
    bool caustics;  // by light paths
};

class ErrorEstimateTest : public testing::TestWithParam<test::Named<Ways>> {
protected:
    ErrorEstimateTest()
    {
        settings.sampler = GetParam().value.sampler;
        settings.caustics = GetParam().value.caustics;
    }
    RenderSettings settings = squareSettings(kSide, kSamples);
};

std::vector<glm::dvec3> meanPicture(const std::vector<Film>& films)
{
    std::vector<glm::dvec3> mean(films[0].pixels.size(), glm::dvec3(0.0));
    for (const Film& film : films) {
        for (std::size_t i = 0; i < mean.size(); ++i) {
            mean[i] += glm::dvec3(shownPixel(film, i).mean) / static_cast<double>(films.size());
        }
    }
    return mean;
}

// Mean squared errors, estimated without bias from the distances to the mean of all `count` films.
SquaredErrors squaredErrors(const Film& film, const std::vector<glm::dvec3>& mean, double count)
{
    const double brightness =
        std::accumulate(mean.begin(), mean.end(), 0.0, [](double sum, const glm::dvec3& m) { return sum + m.r + m.g + m.b; }) /
        (3.0 * static_cast<double>(mean.size()));
    SquaredErrors sums;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const glm::dvec3 distance = glm::dvec3(shownPixel(film, i).mean) - mean[i], square = distance * distance;
        const glm::dvec3 relative = square / (mean[i] * mean[i] + 0.01 * brightness * brightness);
        sums.mse += square.r + square.g + square.b;
        sums.relMse += relative.r + relative.g + relative.b;
    }
    const double scale = count / (count - 1.0) / (3.0 * static_cast<double>(mean.size()));
    return {sums.mse * scale, sums.relMse * scale, 0.0};
}

// What s^2 / n says of the mean square error of a render with Sobol' points; s from the first samples of a block.
double errorBySamples()
{
    constexpr std::uint32_t kFirst = 8;
    const Scene scene = glassRoom();
    RenderSettings settings = squareSettings(kSide, kFirst);
    settings.caustics = false;
    const std::vector<Film> films = renderSingleSamples(scene, settings);
    const std::vector<glm::dvec3> mean = meanPicture(films);
    double variance = 0.0;
    for (const Film& film : films) {
        variance += squaredErrors(film, mean, kFirst).mse / kFirst;
    }
    return variance / kSamples;
}

using Metric = double SquaredErrors::*;

// The true errors of films with different seeds, and the error that each film states.
struct Spread {
    std::vector<SquaredErrors> errors;
    std::vector<ErrorEstimate> estimates;

    double meanReported(Metric metric) const
    {
        double sum = 0.0;
        for (const ErrorEstimate& estimate : estimates) {
            sum += estimate.errors.*metric;
        }
        return sum / static_cast<double>(estimates.size());
    }
    // The mean ratio of the error to the error that is reported.
    std::vector<double> ratios(Metric metric) const
    {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < errors.size(); ++i) {
            ratios.push_back(1.0 + (errors[i].*metric - estimates[i].errors.*metric) / meanReported(metric));
        }
        return ratios;
    }
};

Spread computeSpread(const std::vector<Film>& films)
{
    const std::vector<glm::dvec3> mean = meanPicture(films);
    Spread spread;
    for (const Film& film : films) {
        spread.errors.push_back(squaredErrors(film, mean, static_cast<double>(films.size())));
        spread.estimates.push_back(*estimateError(film));
    }
    return spread;
}

// H30 demands that the variance is .7 to 1.5 times the reported one.
void compareWithSamples(const Spread& spread)
{
    const double meanReported = spread.meanReported(&SquaredErrors::mse), naive = errorBySamples();
    double variance = 0.0;
    for (const SquaredErrors& errors : spread.errors) {
        variance += errors.mse / kSeeds;
    }
    printHardCase("H30", "variance of 64 Sobol' samples", kSeeds, "x " + figure(variance / meanReported) + " of what is reported",
                  "x " + figure(variance / naive) + " of s^2 / n");
    EXPECT_LT(variance / naive, 0.7);
}

// Of `count` intervals of probability .95 at least so many must hold: five standard deviations below the mean.
double minCovered(double count) { return 0.95 * count - 5.0 * std::sqrt(0.95 * 0.05 * count); }

bool holds(const Interval& interval, double error) { return error >= interval.low && error <= interval.high; }

// Of films that do not say that few pixels make up their error, and those of them whose interval holds it.
struct Told {
    double films = 0.0, covered = 0.0;
};

Told expectVariance(const Spread& spread)
{
    Told told;
    for (std::size_t i = 0; i < spread.errors.size(); ++i) {
        const ErrorEstimate& estimate = spread.estimates[i];
        told.films += estimate.isOfFew() ? 0.0 : 1.0;
        told.covered += !estimate.isOfFew() && holds(estimate.mse, spread.errors[i].mse) ? 1.0 : 0.0;
    }
    expectSampleMean("variance over reported variance", spread.ratios(&SquaredErrors::mse), 1.0, 200);
    std::printf("  the interval holds the error of %.0f of %.0f renders (%.0f more say that few pixels make it up)\n", told.covered,
                told.films, static_cast<double>(spread.errors.size()) - told.films);
    return told;
}

TEST_P(ErrorEstimateTest, H30IsTheSpreadOfOtherSeeds)
{
    const Spread spread = computeSpread(renderSeeds(GetParam().value.scene(), settings, kSeeds));
    const Told told = expectVariance(spread);
    EXPECT_GE(told.films, kSeeds / 2) << "or there is little to test";
    EXPECT_GE(told.covered, minCovered(told.films));
    if (settings.sampler == Sampler::Sobol && !settings.caustics) {
        compareWithSamples(spread);
    }
}

// Of few samples there is only a bound, which scrambled points keep too. It is larger than the error where the picture has edges.
TEST_P(ErrorEstimateTest, FewSamplesHaveABound)
{
    settings.sampleEnd = 8;
    const std::vector<Film> films = renderSeeds(GetParam().value.scene(), settings, kSeeds);
    const std::vector<glm::dvec3> mean = meanPicture(films);
    double covered = 0.0, ratio = 0.0;
    for (const Film& film : films) {
        const double bound = boundMse(makePicture(film)).value(), error = squaredErrors(film, mean, kSeeds).mse;
        covered += bound >= error ? 1.0 : 0.0;
        ratio += std::sqrt(bound / error) / kSeeds;
    }
    std::printf("  the bound holds for %.0f of %u renders, and is %.3g times the RMSE on average\n", covered, kSeeds, ratio);
    EXPECT_GE(covered, minCovered(kSeeds));
    EXPECT_LT(ratio, 10.0);
}

// A pixel that has met a caustic has a large variance and a large radiance. Relative to its own square, its error seems a
// fraction of the truth.
TEST_P(ErrorEstimateTest, H30RelativeErrorsAreRelativeToTheTruth)
{
    const std::vector<Film> films = renderSeeds(glassRoom(), settings, kSeeds);
    const Spread spread = computeSpread(films);
    double covered = 0.0, naive = 0.0, truth = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < kSeeds; ++i) {
        covered += holds(spread.estimates[i].relMse, spread.errors[i].relMse) ? 1.0 : 0.0;
        const double error = spread.errors[i].relMse, stated = estimateReferenceNoise(makePicture(films[i]))->relMse;
        naive += stated;
        truth += error;
        squares += (error - stated) * (error - stated);
    }
    const double reported = kSeeds * spread.meanReported(&SquaredErrors::relMse);
    printHardCase("H30", "relMSE of mirror and glass at 64 samples", kSeeds,
                  "x " + figure(reported / truth) + " of the truth; the interval holds " + figure(covered) + " of 32",
                  "relative to the pixel's own value: x " + figure(naive / truth));
    EXPECT_NEAR(reported / truth, 1.0, 0.15) << "neighbours are but like it";
    EXPECT_GE(covered, minCovered(kSeeds));
    const double missing = (truth - naive) / kSeeds;
    const double deviation = std::sqrt((squares / kSeeds - missing * missing) / (kSeeds - 1.0));
    EXPECT_GT(missing, scoreLimit(200) * deviation) << "or the case is not hard";
}

// Blocks of 32, 32, 64 and 128: where a block's variance falls as n^-3/2 (edges), 1.247 times the variance is reported, by calculation, and
// less with more samples. Where it falls as 1/n, the variance is reported.
TEST(ErrorEstimateBlocksTest, H30BlocksOfThreeSizes)
{
    RenderSettings settings = squareSettings(64, 2 * kBlockSamples);
    settings.bounces = 1;
    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/light_directional.gltf");
    const std::vector<double> ratios = computeSpread(renderSeeds(scene, settings, kSeeds)).ratios(&SquaredErrors::mse);
    double mean = 0.0, squares = 0.0;
    for (const double ratio : ratios) {
        mean += ratio / kSeeds;
        squares += ratio * ratio / kSeeds;
    }
    const double error = std::sqrt((squares - mean * mean) / (kSeeds - 1.0)), z = scoreLimit(200);
    printHardCase("H30", "edges, blocks of 32, 32, 64 and 128", kSeeds,
                  "variance x " + figure(mean) + " +- " + figure(error) + " of what is reported");
    EXPECT_GE(mean + z * error, 1.0 / 1.247);
    EXPECT_LE(mean - z * error, 1.0);
}

// 60 films of each scene by one guide.
TEST(GuidedErrorEstimateTest, H30IsTheSpreadOfOtherSeeds)
{
    Told all;
    for (const char* name : {"door_ajar", "mirror_room", "shaded_lamp", "cornell", "closed_room", "showcase"}) {
        std::printf("%s\n", name);
        const Scene scene = loadGltf(std::string(GLIM_SOURCE_DIR "/scenes/") + name + ".gltf");
        RenderSettings settings = squareSettings(2 * kSide, 2 * kSamples);
        settings.caustics = false;
        settings.guide = learnGuide(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings).guide;
        const Told told = expectVariance(computeSpread(renderSeeds(scene, settings, 60)));
        all.films += told.films;
        all.covered += told.covered;
    }
    EXPECT_GE(all.films, 100.0) << "or there is little to test";
    EXPECT_GE(all.covered, minCovered(all.films));
}

INSTANTIATE_TEST_SUITE_P(Samplers, ErrorEstimateTest,
                         testing::Values(test::Named{"sobol", Ways{glassRoom, Sampler::Sobol, false}},
                                         test::Named{"independent", Ways{floorUnderGlass, Sampler::Independent, false}},
                                         test::Named{"light_paths", Ways{floorUnderGlass, Sampler::Sobol, true}}),
                         test::nameOfParameter);

}  // namespace
}  // namespace glim
