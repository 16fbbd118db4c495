// H30: the variance that a picture reports is that of pictures with other seeds.
#include "host/measure/picture.hpp"
#include "host/scene/load_gltf.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/render_scene.hpp"
#include "tests/support/statistics.hpp"
#include "places.h"

#include <gtest/gtest.h>

#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 12, kSamples = 4 * kBlockSamples, kSeeds = 64;

class ErrorEstimateTest : public testing::TestWithParam<Sampler> {};

std::vector<Picture> renderSeeds(Sampler sampler)
{
    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/cornell_spheres.gltf");
    RenderSettings settings = squareSettings(kSide, kSamples);
    settings.sampler = sampler;
    std::vector<Picture> pictures;
    for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) {
        pictures.push_back(pictureOf(renderScene(scene, settings)));
    }
    return pictures;
}

std::vector<glm::dvec3> meanPicture(const std::vector<Picture>& pictures)
{
    std::vector<glm::dvec3> mean(pictures[0].radiance.size(), glm::dvec3(0.0));
    for (const Picture& picture : pictures) {
        for (std::size_t i = 0; i < mean.size(); ++i) {
            mean[i] += glm::dvec3(picture.radiance[i]) / static_cast<double>(pictures.size());
        }
    }
    return mean;
}

double sumOf(const glm::dvec3& v) { return v.r + v.g + v.b; }

// Sums over pixels and channels, per seed: the squared distance from the mean of all seeds (unbiased) and what is reported.
TEST_P(ErrorEstimateTest, H30IsTheSpreadOfOtherSeeds)
{
    const std::vector<Picture> pictures = renderSeeds(GetParam());
    const std::vector<glm::dvec3> mean = meanPicture(pictures);
    std::vector<double> spread, reported;
    for (const Picture& picture : pictures) {
        double squares = 0.0, variance = 0.0;
        for (std::size_t i = 0; i < mean.size(); ++i) {
            const glm::dvec3 distance = glm::dvec3(picture.radiance[i]) - mean[i];
            squares += sumOf(distance * distance);
            variance += sumOf(glm::dvec3(picture.variance[i]));
        }
        spread.push_back(squares * kSeeds / (kSeeds - 1.0));
        reported.push_back(variance);
    }
    const double meanReported = std::accumulate(reported.begin(), reported.end(), 0.0) / kSeeds;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < kSeeds; ++i) {
        ratios.push_back(1.0 + (spread[i] - reported[i]) / meanReported);
    }
    expectSampleMean("variance over reported variance", ratios, 1.0, 200);
}

INSTANTIATE_TEST_SUITE_P(Samplers, ErrorEstimateTest, testing::Values(Sampler::Sobol, Sampler::Independent));

}  // namespace
}  // namespace glim
