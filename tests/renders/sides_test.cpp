// Single-sided surfaces are drawn from behind as from the front: nothing is culled. What they emit is another matter (light_test.cpp).
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

// A screen with its front towards -z, a mirror beside it and a lamp above, seen from +z.
Scene screenFromBehind(bool doubleSided)
{
    SceneBuilder builder;
    const std::uint32_t white = builder.lambert({0.7F, 0.5F, 0.3F}), mirror = builder.mirror({0.9F, 0.8F, 0.7F});
    builder.quad({glm::vec3(-1, -1, 0), {-1, 1, 0}, {0, 1, 0}, {0, -1, 0}}, white);
    builder.quad({glm::vec3(0, -1, 0), {0, 1, 0}, {1, 1, 0}, {1, -1, 0}}, mirror);
    builder.quad({glm::vec3(-1, 3, -1), {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}}, builder.lambert(glm::vec3(0.0F), glm::vec3(2.0F)));
    builder.environment({0.5F, 0.25F, 1.0F});
    builder.perspective({0, 0, 3}, {0, 0, 0}, 0.6F);
    Scene scene = builder.scene();
    scene.materials[white].doubleSided = scene.materials[mirror].doubleSided = doubleSided;
    return scene;
}

TEST(Sides, BackFacesScatterWhetherDoubleSidedOrNot)
{
    const RenderSettings settings = squareSettings(24, 16);
    EXPECT_TRUE(sameBits(renderScene(screenFromBehind(false), settings), renderScene(screenFromBehind(true), settings)));
}

// In a sky of radiance 1 alone, a screen of albedo a that is not culled shows a, and a culled one would show 1.
TEST(Sides, BackFacesHideWhatIsBehindThem)
{
    for (const bool doubleSided : {false, true}) {
        SceneBuilder builder;
        builder.quad({glm::vec3(-1, -1, 0), {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}},
                     builder.lambert(glm::vec3(0.5F), glm::vec3(0), doubleSided));
        builder.environment(glm::vec3(1.0F));
        builder.perspective({0, 0, 3}, {0, 0, 0}, 0.3F);
        expectEverywhere(renderScene(builder.scene(), squareSettings(16, 4)), glm::dvec3(0.5), 2);
    }
}

}  // namespace
}  // namespace glim
