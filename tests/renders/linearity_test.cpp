// T20: light adds up, scales and does not mix its colours.
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

Scene scaled(Scene scene, float factor)
{
    for (Material& material : scene.materials) {
        material.emission *= factor;
    }
    for (PunctualLight& light : scene.lights) {
        light.intensity *= factor;
    }
    scene.environment->radiance *= factor;
    return scene;
}

glm::vec3 rotated(const glm::vec3& c) { return {c.g, c.b, c.r}; }

Scene recolored(Scene scene)
{
    for (Material& material : scene.materials) {
        material.emission = rotated(material.emission);
        material.baseColor = rotated(material.baseColor);
    }
    for (PunctualLight& light : scene.lights) {
        light.intensity = rotated(light.intensity);
    }
    scene.environment->radiance = rotated(scene.environment->radiance);
    return scene;
}

TEST(LinearityTest, T20ThousandfoldLightIsThousandfoldRadianceBitForBit)
{
    const Film once = renderScene(mixedScene(), squareSettings(48, 64));
    const Film more = renderScene(scaled(mixedScene(), 1024.0F), squareSettings(48, 64));
    for (std::size_t i = 0; i < once.pixels.size(); ++i) {
        ASSERT_EQ(once.pixels[i].mean * 1024.0F, more.pixels[i].mean) << "pixel " << i;
        ASSERT_EQ(once.pixels[i].squares * 1048576.0F, more.pixels[i].squares) << "pixel " << i;
    }
}

TEST(LinearityTest, T20PermutedChannelsArePermutedBitForBit)
{
    const Film plain = renderScene(mixedScene(), squareSettings(48, 64));
    const Film turned = renderScene(recolored(mixedScene()), squareSettings(48, 64));
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) {
        ASSERT_EQ(rotated(plain.pixels[i].mean), turned.pixels[i].mean) << "pixel " << i;
    }
}

TEST(LinearityTest, T20LightsAddUp)
{
    const Scene all = mixedScene();
    Scene first = all, second = all;
    first.lights.clear();
    first.environment.reset();
    for (Material& material : second.materials) {
        material.emission = glm::vec3(0.0F);
    }
    const RenderSettings settings = squareSettings(96, samplesFor(128));
    const MeanEstimate a = meanOf(renderScene(first, settings)), b = meanOf(renderScene(second, settings));
    const Film whole = renderScene(all, settings);
    const MeanEstimate sum = meanOf(whole);
    for (int k = 0; k < 3; ++k) {
        const double error = sum.mean[k] - a.mean[k] - b.mean[k];
        const double se = std::sqrt(a.standardError[k] * a.standardError[k] + b.standardError[k] * b.standardError[k] +
                                    sum.standardError[k] * sum.standardError[k]);
        EXPECT_LE(std::abs(error), 4.56 * se) << "channel " << k;
        std::printf("T20 A + B: channel %d, relative error %.2e +- %.1e\n", k, error / sum.mean[k], se / sum.mean[k]);
    }
}

}  // namespace
}  // namespace glim
