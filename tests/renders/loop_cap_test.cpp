// H42: glim refuses a picture whose loops the driver cut short.
#include "host/error.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

class LoopCapTest : public testing::TestWithParam<test::Named<Schedule>> {};

// A ray meets all of 100,000 coincident triangles, more than some drivers allow a loop: the render is refused, or right.
TEST_P(LoopCapTest, H42EndsTheRender)
{
    SceneBuilder builder;
    builder.lambert(glm::vec3(0.5F));
    builder.environment(glm::vec3(1.0F)).perspective({0, 0, 3}, {0, 0, 0}, 0.05F);
    Scene scene = builder.scene();
    addMesh(scene, coincidentTriangles(100000));
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(4, 1);
    settings.schedule = GetParam().value;
    try {
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        EXPECT_EQ(renderer.statistics().loopCaps, 0U) << "noticed, but the render went on";
        for (const PixelMoments& pixel : film.pixels) {
            EXPECT_EQ(pixel.alpha, 1.0F);
            EXPECT_NEAR(pixel.depth, 3.0F, 1e-6F);
        }
    } catch (const DeviceError& error) {
        test::expectMessage(error.message(), MessageId::DeviceLimit);
    }
}

INSTANTIATE_TEST_SUITE_P(Schedules, LoopCapTest,
                         testing::Values(test::Named{"wavefront", Schedule::Wavefront}, test::Named{"persistent", Schedule::Persistent}),
                         test::nameOfParameter);

}  // namespace
}  // namespace glim
