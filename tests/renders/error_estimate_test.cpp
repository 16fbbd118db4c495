// H30: the variance that a picture reports is that of pictures with other seeds, and the interval of its error holds the error.
#include "host/measure/error_estimate.hpp"
#include "host/scene/load_gltf.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/render_scene.hpp"
#include "tests/support/statistics.hpp"
#include "places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 24, kSamples = 2 * kBlockSamples, kSeeds = 32;

class ErrorEstimateTest : public testing::TestWithParam<Sampler> {};

// With a caustic, and more than a few pixels that make up the error.
std::vector<Film> renderSeeds(Sampler sampler)
{
    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/cornell_mirror_glass.gltf");
    RenderSettings settings = squareSettings(kSide, kSamples);
    settings.sampler = sampler;
    std::vector<Film> films;
    for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) {
        films.push_back(renderScene(scene, settings));
    }
    return films;
}

std::vector<glm::dvec3> meanPicture(const std::vector<Film>& films)
{
    std::vector<glm::dvec3> mean(films[0].pixels.size(), glm::dvec3(0.0));
    for (const Film& film : films) {
        for (std::size_t i = 0; i < mean.size(); ++i) {
            mean[i] += glm::dvec3(film.pixels[i].mean) / static_cast<double>(films.size());
        }
    }
    return mean;
}

// Mean square error, of which the distance from the mean of all seeds is an unbiased estimate.
double meanSquareError(const Film& film, const std::vector<glm::dvec3>& mean)
{
    double squares = 0.0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const glm::dvec3 distance = glm::dvec3(film.pixels[i].mean) - mean[i];
        squares += glm::dot(distance, distance);
    }
    return squares / (3.0 * static_cast<double>(mean.size())) * kSeeds / (kSeeds - 1.0);
}

// Of so many intervals of probability .95, five standard deviations below the mean.
double leastCovered(double count) { return 0.95 * count - 5.0 * std::sqrt(0.95 * 0.05 * count); }

TEST_P(ErrorEstimateTest, H30IsTheSpreadOfOtherSeeds)
{
    const std::vector<Film> films = renderSeeds(GetParam());
    const std::vector<glm::dvec3> mean = meanPicture(films);
    std::vector<double> errors;
    std::vector<ErrorEstimate> estimates;
    double meanReported = 0.0, told = 0.0, covered = 0.0;
    for (const Film& film : films) {
        errors.push_back(meanSquareError(film, mean));
        estimates.push_back(*estimateError(film));
        meanReported += estimates.back().errors.mse / kSeeds;
        const bool holds = errors.back() >= estimates.back().mse.low && errors.back() <= estimates.back().mse.high;
        told += estimates.back().isOfFew() ? 0.0 : 1.0;
        covered += !estimates.back().isOfFew() && holds ? 1.0 : 0.0;
    }
    std::vector<double> ratios;
    for (std::size_t i = 0; i < kSeeds; ++i) {
        ratios.push_back(1.0 + (errors[i] - estimates[i].errors.mse) / meanReported);
    }
    expectSampleMean("variance over reported variance", ratios, 1.0, 200);
    std::printf("  the interval holds the error of %.0f of %.0f renders (%.0f more say that few pixels make it up)\n", covered, told,
                kSeeds - told);
    if (GetParam() == Sampler::Sobol) {  // of independent points' error the lamp's rim makes up most: few pixels
        EXPECT_GE(told, kSeeds / 2) << "or there is little to test";
    }
    EXPECT_GE(covered, leastCovered(told));
}

INSTANTIATE_TEST_SUITE_P(Samplers, ErrorEstimateTest, testing::Values(Sampler::Sobol, Sampler::Independent));

}  // namespace
}  // namespace glim
