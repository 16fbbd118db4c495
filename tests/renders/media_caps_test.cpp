// Solids within each other: a path keeps four media. A fifth is counted, not silently forgotten.
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

std::uint32_t capsOf(int solids, Schedule schedule)
{
    SceneBuilder builder;
    for (int i = 0; i < solids; ++i) {
        builder.sphere({0, 0, 0}, 1.0F - 0.15F * static_cast<float>(i), builder.glass(1.1F + 0.1F * static_cast<float>(i)));
    }
    builder.environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 0.05F);
    const Scene scene = builder.scene();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(8, 4);
    settings.schedule = schedule;
    Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras[0], 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    return renderer.statistics().mediaCaps;
}

TEST(MediaCapsTest, AFifthSolidIsCounted)
{
    for (const Schedule schedule : {Schedule::Wavefront, Schedule::Persistent}) {
        EXPECT_EQ(capsOf(4, schedule), 0U);
        EXPECT_GE(capsOf(5, schedule), 200U) << "of 256 camera rays, which all go through the middle";
    }
}

}  // namespace
}  // namespace glim
