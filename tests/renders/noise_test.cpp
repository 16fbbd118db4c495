// The noise of a small picture is that of the film, and knows guides from one another. --guiding auto chooses by it.
#include "host/render/noise.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/learn_guide.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

class NoiseTest : public ::testing::Test {
protected:
    explicit NoiseTest(const char* scene = "door_ajar")
        : scene_(loadGltf(std::string(GLIM_SOURCE_DIR "/scenes/") + scene + ".gltf")),
          flat_(flattened(scene_)),
          camera_(flattenCamera(scene_.cameras.front(), 1.0F, {}))
    {}

    LearnedGuide learn(const RenderSettings& settings, GuideUse use) { return learnGuide(testDevice(), flat_, camera_, settings, use); }

    Scene scene_;
    FlatScene flat_;
    FlatCamera camera_;
};

const auto kGoOn = [] { return true; };

TEST_F(NoiseTest, IsThatOfAFilm)
{
    const RenderSettings settings = squareSettings(32, 1024);
    const Renderer renderer(testDevice(), flat_, camera_, settings);
    NoiseMeter meter(renderer, flat_, camera_, settings);
    const Noise noise = *meter.measure(nullptr, kGoOn);
    const Film film = renderScene(scene_, settings);
    double mean = 0.0, deviation = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        mean += static_cast<double>(pixel.mean.g) / static_cast<double>(film.pixels.size());
    }
    for (const PixelMoments& pixel : film.pixels) {
        const double radiance = std::hypot(static_cast<double>(pixel.mean.g), 0.1 * mean);
        deviation += std::sqrt(static_cast<double>(computeVarianceOfMean(pixel).g) * pixel.count) / radiance;
    }
    deviation /= static_cast<double>(film.pixels.size());
    std::printf("variance %.3f, of the film %.3f, rays %.3f\n", noise.variance, deviation * deviation, noise.rays);
    // Patches of 16 pixels and two blocks in place of one and nine.
    EXPECT_NEAR(noise.variance, deviation * deviation, 0.3 * noise.variance);
    EXPECT_GT(noise.rays, 4.0);
    EXPECT_EQ(meter.measure(nullptr, kGoOn)->work(), noise.work()) << "again";
    EXPECT_EQ(meter.measure(nullptr, [] { return false; }), std::nullopt);
}

TEST_F(NoiseTest, AGuidePaysBehindADoor)
{
    const RenderSettings settings = squareSettings(48, 64);
    const LearnedGuide learned = learn(settings, GuideUse::IfItPays);
    ASSERT_NE(learned.guide, nullptr);
    std::printf("gain %.2f\n", *learned.gain);
    EXPECT_GT(*learned.gain, 1.5);
    RenderSettings other = settings;
    other.seed = 5;
    other.sampleEnd = 100000;
    other.schedule = Schedule::Wavefront;
    const LearnedGuide again = learn(other, GuideUse::IfItPays);
    EXPECT_EQ(again.gain, learned.gain) << "by scene, camera and size alone";
    EXPECT_EQ(again.guide->digest, learned.guide->digest);
}

class NoiseOfARoomTest : public NoiseTest {
protected:
    NoiseOfARoomTest()
        : NoiseTest("closed_room")
    {}
};

TEST_F(NoiseOfARoomTest, HasNoUseForAGuide)
{
    const LearnedGuide learned = learn(squareSettings(32, 64), GuideUse::IfItPays);
    EXPECT_EQ(learned.guide, nullptr);
    EXPECT_EQ(learned.gain, std::nullopt) << "nothing was learned";
}

}  // namespace
}  // namespace glim
