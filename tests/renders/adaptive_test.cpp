// --adaptive: which pixels get samples; each sample is the one that a uniform render takes.
#include "host/flatten/flatten_scene.hpp"
#include "shaders/shared/limits.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/single_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

namespace glim {
namespace {

RenderSettings adaptive(std::uint32_t side, std::uint32_t mostSpp, std::uint32_t batch = 32)
{
    RenderSettings settings = squareSettings(side, mostSpp);
    settings.sampler = Sampler::Independent;
    settings.adaptive = Adaptive::Course;
    settings.course.batch = batch;
    settings.caustics = false;  // as in every render of this rule
    settings.bounces = 3;
    return settings;
}

std::map<std::uint32_t, std::vector<std::size_t>> pixelsByCount(const Film& film)
{
    std::map<std::uint32_t, std::vector<std::size_t>> pixels;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        pixels[film.pixels[i].count].push_back(i);
    }
    return pixels;
}

TEST(AdaptiveTest, EveryPixelHasTheBitsOfAUniformRenderOfItsCount)
{
    RenderSettings settings = adaptive(40, 320, 64);
    settings.course.tolerance = 0.15F;
    const Film film = renderScene(mixedScene(), settings);
    const auto pixels = pixelsByCount(film);
    EXPECT_GE(pixels.size(), 4U);
    settings.adaptive = Adaptive::Off;
    settings.schedule = Schedule::Persistent;  // the film is that of both
    for (const auto& [count, indices] : pixels) {
        EXPECT_TRUE(count % settings.course.batch == 0 || count == 320U) << count;
        settings.sampleEnd = count;
        const Film uniform = renderScene(mixedScene(), settings);
        for (const std::size_t i : indices) {
            EXPECT_EQ(film.pixels[i].mean, uniform.pixels[i].mean) << i;
            EXPECT_EQ(film.pixels[i].squares, uniform.pixels[i].squares) << i;
        }
        std::printf("%zu pixels with %u samples\n", indices.size(), count);
    }
}

// A batch that is no multiple of a block's 32 samples ends inside a block; some pixels stop early in the second page of 256, others
// go on beyond it.
TEST(AdaptiveTest, BatchesMayEndWithinABlock)
{
    RenderSettings settings = adaptive(16, 600, 100);
    settings.course.tolerance = 0.15F;
    const Film film = renderScene(mixedScene(), settings);
    settings.adaptive = Adaptive::Off;
    settings.schedule = Schedule::Persistent;  // the film is that of both
    for (const auto& [count, indices] : pixelsByCount(film)) {
        EXPECT_EQ(count % 100, 0U);
        settings.sampleEnd = count;
        const Film uniform = renderScene(mixedScene(), settings);
        for (const std::size_t i : indices) {
            EXPECT_EQ(film.pixels[i].mean, uniform.pixels[i].mean) << i;
            EXPECT_EQ(film.pixels[i].squares, uniform.pixels[i].squares) << i;
        }
    }
    EXPECT_GT(pixelsByCount(film).count(300), 0U);
    EXPECT_GT(pixelsByCount(film).count(600), 0U);
}

TEST(AdaptiveTest, DoesNotDependOnHowTheWorkIsCut)
{
    RenderSettings settings = adaptive(40, 128);
    settings.course.tolerance = 0.2F;
    const Film film = renderScene(mixedScene(), settings);
    settings.pathCapacity = 1000;
    settings.workgroup = 32;
    EXPECT_TRUE(sameBits(film, renderScene(mixedScene(), settings)));
}

// The stop rule, pixel by pixel, from the luminances of single samples.
TEST(AdaptiveTest, StopsWhereTheRuleSaysSo)
{
    RenderSettings settings = adaptive(12, 96, 16);
    settings.course.tolerance = 0.2F;
    const Film film = renderScene(mixedScene(), settings);
    settings.adaptive = Adaptive::Off;
    std::vector<std::vector<double>> luminances(film.pixels.size());
    for (const Film& one : renderSingleSamples(mixedScene(), settings)) {
        for (std::size_t i = 0; i < one.pixels.size(); ++i) {
            const glm::dvec3 mean(one.pixels[i].mean);
            luminances[i].push_back(0.2126 * mean.r + 0.7152 * mean.g + 0.0722 * mean.b);
        }
    }
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        std::uint32_t n = 0;
        bool done = false;
        while (!done && n < 96) {
            n += 16;
            const double mean = std::accumulate(luminances[i].begin(), luminances[i].begin() + n, 0.0) / n;
            double squares = 0.0;
            for (std::uint32_t s = 0; s < n; ++s) {
                squares += (luminances[i][s] - mean) * (luminances[i][s] - mean);
            }
            const auto& all = luminances[i];
            const bool constant = std::all_of(all.begin(), all.begin() + n, [&](double x) { return x == all[0]; });
            done = !constant && 1.96 * std::sqrt(squares / (n - 1.0) / n) <= 0.2 * mean;
        }
        EXPECT_EQ(film.pixels[i].count, n) << i;
    }
}

// Finished pixels cost nothing: every camera ray is a sample of the film.
TEST(AdaptiveTest, TracesOnlyTheSamplesItKeeps)
{
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = adaptive(40, 256);
    settings.course.tolerance = 0.2F;
    settings.bounces = 0;
    Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
    const Film film = renderer.render([](const RenderProgress& now) { return now.samples <= now.totalSamples; });
    std::uint64_t samples = 0;
    for (const PixelMoments& pixel : film.pixels) {
        samples += pixel.count;
    }
    EXPECT_LT(samples, 40U * 40U * 256U);
    EXPECT_EQ(renderer.statistics().cameraAndBounceRays, samples);
    EXPECT_EQ(renderer.statistics().samples, samples);
}

// H28. A floor of which one sample in 200 finds the lamp, by its scattered ray: the course's rule takes 32 black samples for
// certainty.
TEST(AdaptiveTest, H28ABlackFirstBatchStopsNoPixel)
{
    SceneBuilder builder;
    const float radius = std::sqrt(0.005F);
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F)))
        .sphere({0, 1, 0}, radius, builder.lambert(glm::vec3(0.0F), glm::vec3(10.0F)))
        .orthographic({0.02F, 0.05F, 0.01F}, {0, 0, 0}, 1e-3F);
    RenderSettings settings = adaptive(48, 1024);
    settings.bounces = 1;
    settings.course.direct = DirectLight::Bsdf;
    const auto blackShare = [&](Adaptive rule) {
        settings.adaptive = rule;
        const Film film = renderScene(builder.scene(), settings);
        const auto black =
            std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& pixel) { return pixel.mean.g == 0.0F; });
        return static_cast<double>(black) / static_cast<double>(film.pixels.size());
    };
    const double literal = blackShare(Adaptive::CourseLiteral), guarded = blackShare(Adaptive::Course);
    printHardCase("H28", "one sample in 200 is not black", 48.0 * 48.0, figure(guarded) + " of the pixels stay black",
                  "the course's rule as written: " + figure(literal));
    const double p = std::pow(0.995, 32), n = 48.0 * 48.0;
    EXPECT_NEAR(literal, p, 5.0 * std::sqrt(p * (1.0 - p) / n));
    EXPECT_LE(guarded, 0.01 + 5.0 * std::sqrt(0.01 * 0.99 / n));
}

// A lamp three pixels wide: its middle shines evenly, its rim does not, and nothing is around it.
TEST(AdaptiveTest, H28ConstantPixelsStopAtTheFloor)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 0.4F, builder.lambert(glm::vec3(0.0F), glm::vec3(3.0F))).perspective({0, 0, 5}, {0, 0, 0}, 0.5F);
    RenderSettings settings = adaptive(9, 4096);
    const Film film = renderScene(builder.scene(), settings);
    const auto countAt = [&](const Film& of, int x) { return of.pixels[static_cast<std::size_t>(4 * 9 + x)].count; };
    EXPECT_EQ(countAt(film, 4), kConstantSamples);
    EXPECT_EQ(film.pixels[4 * 9 + 4].mean, glm::vec3(3.0F));
    EXPECT_EQ(countAt(film, 2), kConstantSamples);  // empty, but next to what is not
    EXPECT_EQ(countAt(film, 1), 32U);
    EXPECT_EQ(countAt(film, 0), 32U);
    EXPECT_EQ(film.pixels[4 * 9 + 2].mean, glm::vec3(0.0F));
    settings.adaptive = Adaptive::CourseLiteral;
    EXPECT_EQ(countAt(renderScene(builder.scene(), settings), 4), 32U);
}

// A picture of two tiles, every pixel of which is chosen or not for itself.
TEST(AdaptiveTest, WorksAcrossTiles)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.0F), glm::vec3(3.0F))).perspective({0, 0, 5}, {0, 0, 0}, 0.5F);
    RenderSettings settings = adaptive(1030, 6, 2);
    settings.adaptive = Adaptive::CourseLiteral;
    settings.bounces = 0;
    settings.course.tolerance = 1e-3F;
    const Film film = renderScene(builder.scene(), settings);
    const auto pixels = pixelsByCount(film);
    ASSERT_GT(film.pixels.size(), settings.tilePixels);
    EXPECT_EQ(film.pixels.back().count, 2U);
    EXPECT_GT(pixels.at(6).size(), 500U);  // the rim of the sphere
    settings.adaptive = Adaptive::Off;
    const Film uniform = renderScene(builder.scene(), settings);
    for (const std::size_t i : pixels.at(6)) {
        EXPECT_EQ(film.pixels[i].mean, uniform.pixels[i].mean) << i;
    }
}

}  // namespace
}  // namespace glim
