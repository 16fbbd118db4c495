// No ray is traced whose light cannot count.
#include "host/flatten/flatten_scene.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_device.hpp"

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

}  // namespace
}  // namespace glim
