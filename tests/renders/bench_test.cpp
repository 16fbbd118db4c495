// `glim bench` on a device: its points are those of plain renders, and its slope test fails for renders that are wrong.
#include "host/bench/bench_reference.hpp"
#include "host/bench/run_bench.hpp"
#include "host/bench/summarize_bench.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 12, kSamples = 64, kSeeds = 16;

bool goOn(std::uint64_t) { return true; }

class BenchTest : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        scene = std::make_unique<Scene>(loadGltf(GLIM_SOURCE_DIR "/scenes/cornell_spheres.gltf"));
        flat = std::make_unique<FlatScene>(flattened(*scene));
        reference = std::make_unique<Picture>(
            makePicture(renderFlat(*flat, scene->cameras.front(), referenceSettings(squareSettings(kSide, kSamples), kSamples))));
    }
    static void TearDownTestSuite()
    {
        scene.reset();
        flat.reset();
        reference.reset();
    }

    static FlatCamera camera() { return flattenCamera(scene->cameras.front(), 1.0F); }

    static SceneBench measure(const RenderSettings& settings)
    {
        Renderer renderer(testDevice(), *flat, camera(), settings);
        SceneBench bench;
        bench.width = bench.height = kSide;
        bench.floor = measureFloor(*reference);
        bench.seeds.resize(kSeeds);
        std::iota(bench.seeds.begin(), bench.seeds.end(), 1U);
        const FlatCamera view = camera();
        RenderedSeeds rendered = renderSeeds({{renderer, view}}, bench.seeds, kSamples, *reference, goOn)->front();
        bench.points = std::move(rendered.points);
        bench.bias = rendered.bias;
        return bench;
    }

    static BenchSummary summarize(const std::string& what, const RenderSettings& settings)
    {
        const BenchSummary summary = summarizeBench(measure(settings));
        std::cout << "  " << what << ": slope " << summary.slope.value << " [" << summary.slope.low << ", " << summary.slope.high
                  << "], limit " << -1.0 + summary.slopeTest.slopeMargin << "; bias^2 " << summary.slopeTest.bias << ", limit "
                  << summary.slopeTest.biasLimit << '\n';
        return summary;
    }

    static std::unique_ptr<Scene> scene;
    static std::unique_ptr<FlatScene> flat;
    static std::unique_ptr<Picture> reference;
};

std::unique_ptr<Scene> BenchTest::scene;
std::unique_ptr<FlatScene> BenchTest::flat;
std::unique_ptr<Picture> BenchTest::reference;

TEST_F(BenchTest, PointsAreThoseOfPlainRenders)
{
    RenderSettings settings = squareSettings(kSide, kSamples);
    Renderer renderer(testDevice(), *flat, camera(), settings);
    const FlatCamera view = camera();
    const RenderedSeeds rendered = renderSeeds({{renderer, view}}, {7, 3, 7}, kSamples, *reference, goOn)->front();
    ASSERT_EQ(rendered.points.size(), 7U);
    for (const auto& [place, spp] : {std::pair{2U, 4U}, {5U, 32U}, {6U, 64U}}) {
        const BenchPoint& point = rendered.points[place];
        EXPECT_EQ(point.samples, spp);
        settings.seed = 3;
        settings.sampleEnd = spp;
        const PictureError plain = measureError(makePicture(renderScene(*scene, settings)), *reference);
        EXPECT_EQ(point.relMse[1], plain.relMse);
        EXPECT_EQ(point.mse[1], plain.mse);
        EXPECT_EQ(point.relMse[0], point.relMse[2]);
        EXPECT_NE(point.relMse[0], point.relMse[1]);
    }
    for (std::size_t i = 1; i < rendered.points.size(); ++i) {
        EXPECT_GT(rendered.points[i].seconds[0], rendered.points[i - 1].seconds[0]);
    }
}

// Each seed is rendered by both before the next, and neither is always the first.
TEST_F(BenchTest, SidesTakeTurns)
{
    RenderSettings settings = squareSettings(kSide, kSamples);
    Renderer first(testDevice(), *flat, camera(), settings);
    settings.sampler = Sampler::Independent;
    Renderer second(testDevice(), *flat, camera(), settings);
    const FlatCamera view = camera();
    std::string turns;
    std::uint64_t last = 0;
    const auto note = [&](std::uint64_t samples) {
        const char now = first.plan().sampleCount() > 0 && first.plan().sampleCount() < kSamples ? 'a' : 'b';
        const bool isNext = samples / kSamples > last / kSamples || turns.empty();
        turns += isNext && samples % kSamples > 0 ? std::string(1, now) : std::string();
        last = isNext && samples % kSamples > 0 ? samples : last;
        return true;
    };
    const auto both = renderSeeds({{first, view}, {second, view}}, {1, 2, 3, 4}, kSamples, *reference, note);
    EXPECT_EQ(turns, "abbaabba");
    ASSERT_EQ(both->size(), 2U);
    const auto alone = renderSeeds({{first, view}}, {1, 2, 3, 4}, kSamples, *reference, goOn);
    EXPECT_EQ(both->front().points.back().relMse, alone->front().points.back().relMse);
    EXPECT_EQ(both->front().bias.squared, alone->front().bias.squared);
    EXPECT_NE(both->back().points.back().relMse, alone->front().points.back().relMse);
    for (const RenderedSeeds& side : *both) {
        for (const BenchPoint& point : side.points) {
            EXPECT_EQ(point.cpuSeconds.size(), 4U);
        }
        EXPECT_GT(side.points.back().cpuSeconds[0], 0.0);
    }
}

TEST_F(BenchTest, SlopeTestHoldsForBothSamplers)
{
    RenderSettings settings = squareSettings(kSide, kSamples);
    const BenchSummary sobol = summarize("sobol", settings);
    settings.sampler = Sampler::Independent;
    const BenchSummary independent = summarize("independent", settings);
    EXPECT_TRUE(sobol.slopeTest.holds());
    EXPECT_TRUE(independent.slopeTest.holds());
    EXPECT_GT(independent.slopeTest.slope, -1.0 - independent.slopeTest.slopeMargin);
    EXPECT_FALSE(sobol.points.back().floorLimited);
}

TEST_F(BenchTest, SlopeTestFailsForBias)
{
    RenderSettings settings = squareSettings(kSide, kSamples);
    settings.bounces = 1;
    const BenchSummary dark = summarize("one bounce", settings);
    EXPECT_FALSE(dark.slopeTest.biasHolds());
    EXPECT_FALSE(dark.slopeTest.slopeHolds());
}

TEST_F(BenchTest, ChoosesAPowerOfTwoThatTakesAboutAsLong)
{
    RenderSettings settings = squareSettings(kSide, 1U << 20);
    Renderer renderer(testDevice(), *flat, camera(), settings);
    EXPECT_EQ(chooseSamples(renderer, camera(), 1e-3, 1U << 20, goOn), kMinBenchSamples);
    EXPECT_EQ(chooseSamples(renderer, camera(), 1e6, 128, goOn), 128U);
    EXPECT_FALSE(chooseSamples(renderer, camera(), 1.0, 128, [](std::uint64_t) { return false; }));
}

}  // namespace
}  // namespace glim
