// No ray is traced whose light cannot count.
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

std::uint64_t closestRays(const glm::vec3& albedo)
{
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(albedo, glm::vec3(1.0F)), true).perspective({0, 0, 0}, {0, 0, -1}, 1.0F);
    const FlatScene flat = flattened(builder.scene());
    RenderSettings settings = squareSettings(16, 4);
    settings.bounces = 3;
    Renderer renderer(testDevice(), flat, flattenCamera(builder.scene().cameras.front(), 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    return renderer.statistics().cameraAndBounceRays;
}

TEST(RayCountTest, BlackSurfacesEndPaths)
{
    EXPECT_EQ(closestRays(glm::vec3(0.0F)), 16U * 16U * 4U);
    EXPECT_GT(closestRays(glm::vec3(1.0F)), 3U * 16U * 16U * 4U);  // four segments a path, but for directions in the wall
}

RenderStatistics countIn(const SceneBuilder& builder, RenderSettings settings)
{
    const FlatScene flat = flattened(builder.scene());
    Renderer renderer(testDevice(), flat, flattenCamera(builder.scene().cameras.front(), 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    return renderer.statistics();
}

// Where lights are sampled at every hit, a ray after the last hit would find only light that does not count. With --paths
// indirect, light sampled at the first hit does not count either.
TEST(RayCountTest, LightSamplingNeedsNoLastRay)
{
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F)), true).perspective({0, 0, 0}, {0, 0, -1}, 1.0F);
    constexpr std::uint64_t kCountedSamples = 16 * 16 * 4;
    RenderSettings settings = squareSettings(16, 4);
    settings.bounces = 1;
    for (const DirectLight direct : {DirectLight::Lights, DirectLight::Hemisphere}) {
        settings.course.direct = direct;
        const RenderStatistics counts = countIn(builder, settings);
        EXPECT_EQ(counts.cameraAndBounceRays, kCountedSamples);
        EXPECT_GT(counts.shadowRays, kCountedSamples / 4);
    }
    settings.paths = PathParts::Indirect;
    settings.bounces = 2;
    EXPECT_LE(countIn(builder, settings).shadowRays, kCountedSamples);
}

TEST(RayCountTest, BlackSurfacesNeedNoDirections)
{
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F)), true).perspective({0, 0, 0}, {0, 0, -1}, 1.0F);
    RenderSettings settings = squareSettings(16, 4);
    settings.course.direct = DirectLight::Hemisphere;
    EXPECT_EQ(countIn(builder, settings).shadowRays, 0U);
}

}  // namespace
}  // namespace glim
