#include "tests/support/render_scene.hpp"

#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/start_media.hpp"
#include "host/measure/confidence.hpp"
#include "shaders/shared/limits.h"
#include "tests/harness/test_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>

namespace glim {
namespace {

// The family: what all whole-picture tests compare.
constexpr double kFamilyLevel = 1e-3;
constexpr std::size_t kFamilySize = 200;

// `watch` is called after each pass.
Film renderBy(
    Schedule schedule, const FlatScene& flat, const FlatCamera& camera, RenderSettings settings,
    const std::function<void(Renderer&)>& watch = [](Renderer&) {})
{
    settings.schedule = schedule;
    Renderer renderer(testDevice(), flat, camera, settings);
    while (!settings.seconds && renderer.advance()) {
        watch(renderer);
    }
    Film film = renderer.render([](const RenderProgress&) { return true; });
    EXPECT_EQ(renderer.statistics().nonFinite, 0U)
        << (renderer.statistics().located.empty() ? std::string()
                                                  : "pixel " + std::to_string(renderer.statistics().located[0].pixel) + ", sample " +
                                                        std::to_string(renderer.statistics().located[0].sampleIndex));
    return film;
}

// Samples of each pixel on which the schedules are compared: all, or the first that make 2^18 paths, up to the end of a sweep. A difference
// in one path of 57,000 is seen with a probability of .99, by one picture of many.
std::uint32_t comparedSamples(const RenderSettings& settings)
{
    constexpr std::uint32_t kPaths = 1U << 18;
    if (settings.adaptive != Adaptive::Off || settings.sampleBegin > 0 || samplesFor(1) > 1) {
        return settings.sampleEnd;
    }
    const std::uint32_t pixels = settings.width * settings.height, samples = (kPaths + pixels - 1) / pixels;
    const std::uint32_t blocks = (samples + kBlockSamples - 1) / kBlockSamples;
    return std::min(settings.sampleEnd, samples < kBlockSamples ? std::bit_ceil(samples) : blocks * kBlockSamples);
}

float aspectOf(const RenderSettings& settings) { return static_cast<float>(settings.width) / static_cast<float>(settings.height); }

Film renderBySchedules(const FlatScene& flat, const FlatCamera& flatCamera, const RenderSettings& settings)
{
    if (settings.schedule != Schedule::Auto || usesCourseEstimators(settings) || settings.seconds) {
        return renderBy(settings.schedule, flat, flatCamera, settings);
    }
    RenderSettings first = settings;
    first.sampleEnd = comparedSamples(settings);
    const Film wavefront = renderBy(Schedule::Wavefront, flat, flatCamera, first);
    bool compared = false;
    Film film = renderBy(Schedule::Persistent, flat, flatCamera, settings, [&](Renderer& renderer) {
        const std::uint64_t samples = std::uint64_t{first.sampleEnd} * settings.width * settings.height;
        if (!compared && first.sampleEnd < settings.sampleEnd && renderer.plan().pictureSamples() == samples) {
            compared = true;
            EXPECT_TRUE(sameBits(wavefront, renderer.film())) << "by the two schedules, after " << first.sampleEnd << " samples";
        }
    });
    EXPECT_TRUE(compared || sameBits(wavefront, film)) << "by the two schedules";
    return film;
}

}  // namespace

FlatScene flattened(const Scene& scene, SplitRule rule)
{
    const Primitives primitives = makePrimitives(scene);
    return flattenScene(scene, primitives, buildSceneBvh(primitives, rule));
}

Film renderFlat(const FlatScene& flat, const Camera& camera, const RenderSettings& settings)
{
    return renderBySchedules(flat, flattenCamera(camera, aspectOf(settings)), settings);
}

Film renderScene(const Scene& scene, const RenderSettings& settings)
{
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = setInMotion(flattenCamera(scene.cameras.front(), aspectOf(settings)), scene.cameras.front(), flat);
    return renderBySchedules(flat, placeInMedia(camera, flat), settings);
}

std::vector<Film> renderSeeds(const Scene& scene, const RenderSettings& settings, std::uint32_t count)
{
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = setInMotion(flattenCamera(scene.cameras.front(), aspectOf(settings)), scene.cameras.front(), flat);
    Renderer renderer(testDevice(), flat, camera, settings);
    std::vector<Film> films;
    for (std::uint32_t seed = 0; seed < count; ++seed) {
        renderer.restart(camera, settings.seed + seed);
        films.push_back(renderer.render([](const RenderProgress&) { return true; }));
    }
    return films;
}

RenderSettings squareSettings(std::uint32_t side, std::uint32_t spp)
{
    RenderSettings settings;
    settings.width = settings.height = side;
    settings.sampleEnd = spp;
    return settings;
}

std::uint32_t samplesFor(std::uint32_t spp, std::uint32_t factor) { return std::getenv("GLIM_LONG") != nullptr ? spp * factor : spp; }

MeanEstimate meanOf(const Film& film)
{
    glm::dvec3 sum(0.0), variance(0.0);
    for (const PixelMoments& pixel : shownPixels(film)) {
        sum += glm::dvec3(pixel.mean);
        variance += glm::dvec3(computeVarianceOfMean(pixel));
    }
    const double pixels = static_cast<double>(film.pixels.size());
    return {sum / pixels, glm::sqrt(variance) / pixels};
}

void expectEverywhere(const Film& film, const glm::dvec3& truth, int bounces)
{
    double worst = 0.0;
    for (const PixelMoments& pixel : shownPixels(film)) {
        const glm::dvec3 error = glm::abs(glm::dvec3(pixel.mean) - truth) / truth;
        worst = std::max({worst, error.r, error.g, error.b});
    }
    EXPECT_LE(worst, bounces * 0x1p-20) << "largest relative error of a pixel";
}

bool sameBits(const Film& a, const Film& b)
{
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    return same(a.pixels, b.pixels) && same(a.splats, b.splats) && same(a.catcher, b.catcher) && same(a.groups.values, b.groups.values) &&
           same(a.splatGroups.values, b.splatGroups.values);
}

void expectSameMean(const std::string& name, const Film& a, const Film& b)
{
    const MeanEstimate x = meanOf(a), y = meanOf(b);
    const double z = twoSidedLimit(kFamilyLevel / kFamilySize);
    for (int k = 0; k < 3; ++k) {
        const double error = std::hypot(x.standardError[k], y.standardError[k]);
        EXPECT_LE(std::abs(x.mean[k] - y.mean[k]), z * error + 2e-5 * y.mean[k])
            << name << ", channel " << k << ": " << x.mean[k] << " and " << y.mean[k];
        if (k == 0) {
            std::printf("%s: ratio of means - 1 = %.2e +- %.1e\n", name.c_str(), x.mean[k] / y.mean[k] - 1.0, error / y.mean[k]);
        }
    }
}

void expectMean(const std::string& name, const Film& film, const glm::dvec3& truth)
{
    const MeanEstimate estimate = meanOf(film);
    const double z = twoSidedLimit(kFamilyLevel / kFamilySize);
    for (int k = 0; k < 3; ++k) {
        const double error = estimate.mean[k] - truth[k];
        EXPECT_LE(std::abs(error), z * estimate.standardError[k] + 2e-5 * truth[k])
            << name << ", channel " << k << ": " << estimate.mean[k] << ", truth " << truth[k];
        if (k == 0) {
            std::printf("%s: %.7g, truth %.7g, relative error %.2e +- %.1e (sees %.1e)\n", name.c_str(), estimate.mean[k], truth[k],
                        error / truth[k], estimate.standardError[k] / truth[k], (z + 2.33) * estimate.standardError[k] / truth[k]);
        }
    }
}

}  // namespace glim
