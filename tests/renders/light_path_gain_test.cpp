// Which kind of paths finds caustics with less noise, by an estimate from a small picture.
#include "host/render/light_path_gain.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/caustic_films.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <stdexcept>

namespace glim {
namespace {

// A closed room with a lamp in a globe of glass, and a camera that looks at the floor.
Scene globe(float lamp, float yfov)
{
    SceneBuilder b;
    b.cube(1.0F, b.lambert(glm::vec3(0.6F)), true)
        .sphere({0.0F, 0.4F, 0.0F}, 0.25F, b.glass(1.5F))
        .sphere({0.0F, 0.4F, 0.0F}, lamp, b.lambert(glm::vec3(0.0F), glm::vec3(20.0F)))
        .perspective({0.0F, 0.2F, 0.9F}, {0.3F, -1.0F, 0.0F}, yfov);
    return b.scene();
}

// A mirror for a wall under a lamp that is as large as the ceiling.
Scene brightCeiling()
{
    SceneBuilder b;
    b.quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, b.lambert(glm::vec3(0.0F), glm::vec3(1.0F)))
        .quad({glm::vec3(-1, -1, -1), {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}, b.mirror(glm::vec3(0.9F)))
        .quad({glm::vec3(-1, -1, 1), {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}, b.lambert(glm::vec3(0.7F)))
        .perspective({0.0F, 0.0F, 3.0F}, {0, -0.5F, 0}, 0.8F);
    return b.scene();
}

FlatCamera cameraOf(const Scene& scene) { return flattenCamera(scene.cameras.front(), 1.0F, {}); }

LightPathGain measure(const Scene& scene, RenderSettings settings = squareSettings(64, 64))
{
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = cameraOf(scene);
    const Renderer renderer(testDevice(), flat, camera, settings);
    const LightPathGain gain = measureLightPaths(renderer, flat, camera, settings);
    std::printf("variance of the rest %.4g, caustics by light paths %.4g, by camera paths %.4g; rays %.3f\n", gain.rest, gain.light,
                gain.camera, gain.work);
    return gain;
}

TEST(LightPathGainTest, TellsWhoIsBetter)
{
    EXPECT_TRUE(measure(globe(0.03F, 1.0F)).isGain());
    // Few light paths reach what a narrow camera sees.
    EXPECT_FALSE(measure(globe(0.03F, 0.02F)).isGain());
    EXPECT_FALSE(measure(brightCeiling()).isGain());
}

// What light paths say of camera paths is what these have. The lamp is in the glass, and light goes to and fro in the room.
TEST(LightPathGainTest, KnowsTheVarianceOfCameraPaths)
{
    const Scene scene = globe(0.15F, 1.0F);
    const LightPathGain gain = measure(scene);
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(32, 2048);
    settings.sampler = Sampler::Independent;
    struct Variances {
        double camera = 0.0, light = 0.0;  // of both kinds of paths
    };
    const auto varianceOf = [&](bool byLightPaths) {
        const Film film = renderCaustics(flat, cameraOf(scene), settings, byLightPaths);
        Variances sum;
        constexpr std::size_t kPatch = 8;
        for (std::size_t top = 0; top < 32; top += kPatch) {
            for (std::size_t left = 0; left < 32; left += kPatch) {
                double radiance = 0.0;
                Variances variance;
                for (std::size_t i = 0; i < kPatch * kPatch; ++i) {
                    const std::size_t at = (top + i / kPatch) * 32 + left + i % kPatch;
                    const PixelMoments& pixel = film.pixels[at];
                    radiance += static_cast<double>(pixel.mean.g + (byLightPaths ? film.splats[at].mean.g : 0.0F)) / (kPatch * kPatch);
                    variance.camera += static_cast<double>(pixel.squares.g) / (pixel.blocks - 1.0);
                    if (byLightPaths) {
                        variance.light += static_cast<double>(film.splats[at].squares.g) / (film.splats[at].blocks - 1.0);
                    }
                }
                sum.camera += variance.camera / (radiance * radiance * 32 * 32);
                sum.light += variance.light / (radiance * radiance * 32 * 32);
            }
        }
        return sum;
    };
    const Variances with = varianceOf(true), without = varianceOf(false);
    const double camera = without.camera - with.camera;
    std::printf("with 2,048 samples: by light paths %.4g, by camera paths %.4g\n", with.light, camera);
    // The small picture has 64 samples a pixel, and 6,600 light paths.
    EXPECT_NEAR(gain.camera, camera, 0.2 * camera);
    EXPECT_NEAR(gain.light, with.light, 0.2 * with.light);
}

TEST(LightPathGainTest, DependsOnNothingElse)
{
    const LightPathGain usual = measure(globe(0.1F, 1.0F));
    RenderSettings other = squareSettings(64, 64);
    other.schedule = Schedule::Wavefront;
    other.workgroup = 32;
    other.seed = 7;
    other.sampleBegin = 32;
    other.rows = {16, 32};
    const LightPathGain same = measure(globe(0.1F, 1.0F), other);
    EXPECT_EQ(usual.rest, same.rest);
    EXPECT_EQ(usual.light, same.light);
    EXPECT_EQ(usual.camera, same.camera);
    EXPECT_EQ(usual.work, same.work);
}

TEST(LightPathGainTest, IsNotMeasuredWhereThereIsNoChoice)
{
    const auto refuse = []() -> const Renderer& { throw std::logic_error("there is no choice"); };
    Scene scene = globe(0.1F, 0.02F);
    const FlatCamera camera = cameraOf(scene);
    RenderSettings settings = squareSettings(64, 64);
    settings.bounces = 1;  // no caustics
    EXPECT_NO_THROW(choosesLightPaths(flattened(scene), camera, settings, refuse));
    settings.bounces = 64;
    EXPECT_THROW(choosesLightPaths(flattened(scene), camera, settings, refuse), std::logic_error);
    EXPECT_FALSE(choosesLightPaths(testDevice(), flattened(scene), camera, settings));
    scene.lights.push_back({"", PunctualLight::Kind::Point, {0.5F, -0.5F, 0.5F}, {0, 0, -1}, glm::vec3(1.0F)});
    EXPECT_TRUE(choosesLightPaths(flattened(scene), camera, settings, refuse));  // which camera paths never find
}

}  // namespace
}  // namespace glim
