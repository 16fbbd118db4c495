// --adaptive neighbours: pixels get samples by the noise around them. The samples are those of a uniform render, and the picture is neither
// darker nor noisier.
#include "host/flatten/flatten_scene.hpp"
#include "host/measure/error_estimate.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/statistics.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

namespace glim {
namespace {

RenderSettings neighbours(std::uint32_t side, std::uint32_t meanSpp)
{
    RenderSettings settings = squareSettings(side, meanSpp);
    settings.adaptive = Adaptive::Neighbours;
    settings.bounces = 3;
    return settings;
}

std::uint64_t samplesOf(const Film& film)
{
    std::uint64_t samples = 0;
    for (const PixelMoments& pixel : film.pixels) {
        samples += pixel.count;
    }
    return samples;
}

// A lamp low above a floor, which half of the picture sees. The other half sees nothing.
Scene halfEmptyScene()
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-5, 0, 5), {0, 0, 5}, {0, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F)))
        .sphere({-2.5F, 1, 0}, 0.2F, builder.lambert(glm::vec3(0.0F), glm::vec3(10.0F)))
        .orthographic({0, 6, 0}, {0, 0, 0}, 5.0F);
    return builder.scene();
}

Film uniform(const Scene& scene, RenderSettings settings, std::uint32_t begin, std::uint32_t end)
{
    settings.adaptive = Adaptive::Off;
    settings.schedule = Schedule::Persistent;
    settings.sampleBegin = begin;
    settings.sampleEnd = end;
    return renderScene(scene, settings);
}

// The same but for float rounding: uniform renders fold pages of 256 samples, rounds fold what each of them has.
void expectSameButForRounding(const PixelMoments& pixel, const PixelMoments& expected)
{
    EXPECT_EQ(pixel.count, expected.count);
    EXPECT_EQ(pixel.blocks, expected.blocks);
    EXPECT_LE(glm::length(pixel.mean - expected.mean), 1e-6F * glm::length(expected.mean));
    const float rounding = 1e-11F * static_cast<float>(pixel.count) * glm::dot(expected.mean, expected.mean);
    EXPECT_LE(glm::length(pixel.squares - expected.squares), 1e-4F * glm::length(expected.squares) + rounding);
    EXPECT_LE(std::abs(pixel.alpha - expected.alpha), 1e-6F);
}

// The first samples are the same for all pixels. The others begin at an index that the first ones never reach.
TEST(NeighboursTest, EveryPixelHasTheSamplesOfUniformRenders)
{
    const RenderSettings settings = neighbours(32, 300);
    const Film film = renderScene(mixedScene(), settings);
    constexpr std::uint32_t kCommon = 128, kBegin = 256;  // 300 / 2, whole blocks down and up
    ASSERT_EQ(film.sampleRanges.size(), 2U);
    EXPECT_EQ(film.sampleRanges[0], std::pair(0U, kCommon));
    EXPECT_EQ(film.sampleRanges[1].first, kBegin);
    std::map<std::uint32_t, std::vector<std::size_t>> pixels;
    std::uint32_t most = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        pixels[film.pixels[i].count].push_back(i);
        most = std::max(most, film.pixels[i].count);
    }
    EXPECT_EQ(film.sampleRanges[1].second, kBegin + most - kCommon);
    EXPECT_GE(pixels.size(), 4U);
    const Film common = uniform(mixedScene(), settings, 0, kCommon);
    for (const auto& [count, indices] : pixels) {
        EXPECT_EQ(count % kBlockSamples, 0U);
        const Film others = count == kCommon ? Film() : uniform(mixedScene(), settings, kBegin, kBegin + count - kCommon);
        for (const std::size_t i : indices) {
            SCOPED_TRACE(i);
            expectSameButForRounding(film.pixels[i], count == kCommon ? common.pixels[i] : foldMoments(common.pixels[i], others.pixels[i]));
        }
        std::printf("%zu pixels with %u samples\n", indices.size(), count);
    }
}

TEST(NeighboursTest, DoesNotDependOnHowTheWorkIsCut)
{
    RenderSettings settings = neighbours(28, 150);
    const Film film = renderScene(mixedScene(), settings);
    settings.pathCapacity = 1000;
    settings.workgroup = 32;
    settings.tilePixels = 300;
    EXPECT_TRUE(sameBits(film, renderScene(mixedScene(), settings)));
    const Scene scene = mixedScene();
    Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
    int calls = 0;
    while (!renderer.plan().isDone()) {
        renderer.advance([&] { return ++calls % 70 != 3; });  // now and then a pass is given up
        renderer.film();
    }
    EXPECT_TRUE(sameBits(film, renderer.film()));
    renderer.restart(flattenCamera(scene.cameras.front(), 1.0F), settings.seed);
    while (renderer.advance()) {
    }
    EXPECT_TRUE(sameBits(film, renderer.film()));
}

TEST(NeighboursTest, PixelsHaveTheWantedSamplesOnAverage)
{
    const Scene scene = halfEmptyScene();
    for (const std::uint32_t spp : {65U, 96U, 128U, 300U}) {
        Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), neighbours(20, spp));
        std::uint64_t last = 0;
        const Film film = renderer.render([&](const RenderProgress& now) {
            EXPECT_LE(now.samples, now.totalSamples + kBlockSamples);
            last = now.samples;
            return true;
        });
        EXPECT_NEAR(static_cast<double>(samplesOf(film)), 400.0 * spp, 0.5 * kBlockSamples) << spp;
        EXPECT_EQ(renderer.statistics().samples, samplesOf(film));
        EXPECT_EQ(last, samplesOf(film));
        EXPECT_TRUE(film.complete);
        EXPECT_TRUE(renderer.plan().isDone());
        if (spp == 300) {
            // Each half gets a half of the samples that is spread evenly; the other half goes to where there is noise.
            EXPECT_EQ(film.pixels[10 * 20 + 17].count, 128U);  // of 300 / 2, whole blocks
            EXPECT_GT(film.pixels[10 * 20 + 5].count, 400U);
        }
    }
}

TEST(NeighboursTest, ATargetEndsItWithTheRoundThatReachesIt)
{
    const Scene scene = mixedScene();
    RenderSettings settings = neighbours(24, kPilotSamples);
    const double target = 0.4 * estimateError(renderScene(scene, settings))->errors.relMse;
    settings.sampleEnd = 1U << 20;
    Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
    const Film film = renderer.render([](const RenderProgress&) { return true; },
                                      [&](const Film& now) { return estimateError(now)->errors.relMse / target; });
    const double reached = estimateError(film)->errors.relMse;
    EXPECT_LE(reached, target);
    EXPECT_GE(reached, 0.8 * target) << "rounds end near the target";
    EXPECT_TRUE(film.complete);
    EXPECT_GT(samplesOf(film), film.pixels.size() * kPilotSamples);
    EXPECT_FALSE(renderer.plan().isDone());
}

// Given up in the middle of a round: whole blocks, and no claim of more.
TEST(NeighboursTest, AFilmOfAnUnfinishedRoundSaysSo)
{
    const Scene scene = mixedScene();
    RenderSettings settings = neighbours(28, 300);
    settings.pathCapacity = 2000;  // so that a round has many passes
    Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
    while (renderer.plan().sampleCount() < 192) {
        renderer.advance();
    }
    EXPECT_TRUE(renderer.film().complete);
    int unfinished = 0;
    for (; renderer.plan().sampleCount() == 192; ++unfinished) {
        const Film film = renderer.film();
        EXPECT_EQ(film.complete, unfinished == 0);
        for (const PixelMoments& pixel : film.pixels) {
            std::uint32_t possible = 0;
            for (const auto& [begin, end] : film.sampleRanges) {
                possible += end - begin;
            }
            EXPECT_EQ(pixel.count % 64, 0U) << "blocks are whole";
            EXPECT_LE(pixel.count, possible);
            EXPECT_GE(pixel.count, 64U);
        }
        renderer.advance();
    }
    EXPECT_GT(unfinished, 3);
    // Another size in the middle of a round, and back.
    const Film whole = renderScene(scene, settings);
    renderer.advance();
    renderer.restart(flattenCamera(scene.cameras.front(), 1.0F), 13, 13);
    while (renderer.plan().sampleCount() < 128) {
        renderer.advance();
    }
    renderer.advance();
    renderer.restart(flattenCamera(scene.cameras.front(), 1.0F), 28, 28);
    while (renderer.advance()) {
    }
    EXPECT_TRUE(sameBits(renderer.film(), whole));
}

// The control has samples of a uniform render that the film does not have. They change nothing of what is reported.
TEST(NeighboursTest, TheControlIsNewSamplesOfAFewPixels)
{
    const Scene scene = mixedScene();
    for (const Adaptive adaptive : {Adaptive::Neighbours, Adaptive::Course}) {
        RenderSettings settings = neighbours(40, 80);
        settings.adaptive = adaptive;
        settings.sampler = adaptive == Adaptive::Course ? Sampler::Independent : Sampler::Sobol;
        settings.tilePixels = 700;
        settings.caustics = adaptive == Adaptive::Neighbours;  // the course has none
        settings.portion = 2;
        settings.uncheckedSeconds = 0.0;
        Renderer renderer(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        const RenderStatistics before = renderer.statistics();
        int asked = 0;
        EXPECT_FALSE(renderer.sampleControl(film, [&] { return ++asked < 4; }));
        EXPECT_EQ(renderer.statistics().samples, before.samples) << "given up after some passes";
        Renderer other(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
        const auto control = other.sampleControl(other.render([](const RenderProgress&) { return true; }), [] { return true; });
        ASSERT_TRUE(control);
        EXPECT_EQ(other.statistics().samples, before.samples);
        const std::uint32_t begin = (film.sampleRanges.back().second + kBlockSamples - 1) / kBlockSamples * kBlockSamples;
        std::map<std::uint32_t, std::vector<std::size_t>> pixels;
        std::size_t count = 0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            if (control->pixels[i].count > 0) {
                EXPECT_EQ(control->pixels[i].count, (film.pixels[i].count + kBlockSamples - 1) / kBlockSamples * kBlockSamples);
                pixels[control->pixels[i].count].push_back(i);
                ++count;
            }
        }
        EXPECT_NEAR(static_cast<double>(count), 64.0, 5.0 * 8.0);
        for (const auto& [samples, indices] : pixels) {
            const Film expected = uniform(scene, settings, begin, begin + samples);
            for (const std::size_t i : indices) {
                SCOPED_TRACE(i);
                expectSameButForRounding(control->pixels[i], expected.pixels[i]);
            }
        }
    }
}

// Where noise is uneven, as many samples leave less of it.
TEST(NeighboursTest, TheErrorIsLess)
{
    RenderSettings settings = neighbours(32, 192);
    for (const Adaptive adaptive : {Adaptive::Neighbours, Adaptive::NeighboursAbsolute}) {
        double error = 0.0, uniformError = 0.0;
        for (const Adaptive each : {adaptive, Adaptive::Off}) {
            settings.adaptive = each;
            for (const Film& film : renderSeeds(halfEmptyScene(), settings, 4)) {
                const SquaredErrors errors = estimateError(film)->errors;
                (each == Adaptive::Off ? uniformError : error) += adaptive == Adaptive::Neighbours ? errors.relMse : errors.mse;
            }
        }
        std::printf("error x %.3f\n", error / uniformError);
        EXPECT_LT(error, 0.8 * uniformError);
    }
}

// H29. Against uniform renders of the same seeds, which share the first 64 samples. Beside it the course's rule, which looks at each
// pixel by itself.
TEST(NeighboursTest, H29PictureIsNotDarker)
{
    constexpr std::uint32_t kSeeds = 24;
    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/cornell_mirror_glass.gltf");
    RenderSettings settings = neighbours(20, 128);
    settings.bounces = 64;
    const auto meansOfRule = [&](Adaptive adaptive, std::uint32_t seeds) {
        RenderSettings other = settings;
        other.adaptive = adaptive;
        if (isCourse(adaptive)) {
            other.sampler = Sampler::Independent;
            other.course.tolerance = 0.2F;
            other.sampleEnd = 256;
        }
        std::vector<double> means;
        for (const Film& film : renderSeeds(scene, other, seeds)) {
            const glm::dvec3 mean = meanOf(film).mean;
            means.push_back((mean.r + mean.g + mean.b) / 3.0);
        }
        return means;
    };
    const std::vector<double> uniform = meansOfRule(Adaptive::Off, kSeeds);
    const auto lessUniform = [&](std::vector<double> means) {
        std::transform(means.begin(), means.end(), uniform.begin(), means.begin(), [](double a, double b) { return a / b - 1.0; });
        return means;
    };
    const std::vector<double> differences = lessUniform(meansOfRule(Adaptive::Neighbours, kSeeds));
    const std::vector<double> stopped = lessUniform(meansOfRule(Adaptive::Course, 8));
    const auto average = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    };
    printHardCase("H29", "mirror and glass, 24 seeds of 20x20 at 128 samples", kSeeds * 400.0 * 128.0,
                  "mean " + figure(100.0 * average(differences)) + " % off uniform renders'",
                  "the course's rule at tolerance .2: " + figure(100.0 * average(stopped)) + " %");
    expectSampleMean("adaptive over uniform, less 1", differences, 0.0, 1);
    EXPECT_LT(average(stopped), -0.01) << "the course's rule is what this would notice";
}

}  // namespace
}  // namespace glim
