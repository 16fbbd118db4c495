#include "host/flatten/media.hpp"
#include "tests/support/build_scene.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

// A cube of one glass about the scene's origin, and a ball of another around `center`, which is relative to that origin.
Scene cubeAndBall(const glm::vec3& center, const glm::dvec3& origin)
{
    SceneBuilder builder;
    const std::uint32_t cube = builder.glass(1.5F), ball = builder.glass(1.3F);
    Scene scene = builder.cube(1.0F, cube, false).sphere(center, 0.5F, ball).scene();
    scene.origin = origin;
    for (MeshInstance& instance : scene.instances) {
        instance.worldFromMesh[3] = glm::dvec4(origin, 1.0);
    }
    return scene;
}

TEST(FindMediaTest, SolidsOfDifferentMediaThatOverlapAreTracked)
{
    for (const glm::dvec3& origin : {glm::dvec3(0.0), glm::dvec3(1000.0, -20.0, 3.0)}) {
        EXPECT_TRUE(findMedia(cubeAndBall(glm::vec3(0.0F), origin)).tracked);
        EXPECT_TRUE(findMedia(cubeAndBall(glm::vec3(1.4F, 0.0F, 0.0F), origin)).tracked);
        EXPECT_FALSE(findMedia(cubeAndBall(glm::vec3(1.6F, 0.0F, 0.0F), origin)).tracked);
    }
}

// By its scattering a medium differs from others; the anisotropy of what does not scatter makes none.
TEST(FindMediaTest, MediaDifferByTheirScattering)
{
    const auto count = [](float scattering, float anisotropy) {
        SceneBuilder builder;
        Scene scene = builder.cube(1.0F, builder.glass(1.5F), false).sphere({5, 0, 0}, 0.5F, builder.glass(1.5F)).scene();
        scene.materials[0].absorption = glm::vec3(1.0F);
        scene.materials[1].absorption = glm::vec3(1.0F - scattering);
        scene.materials[1].scattering = glm::vec3(scattering);
        scene.materials[1].scatterAnisotropy = anisotropy;
        const Media media = findMedia(scene);
        EXPECT_EQ(media.scattering.size(), media.media.size());
        EXPECT_EQ(media.media[0].extinction, media.media.back().extinction);
        EXPECT_EQ(media.scattering.back().albedo, glm::vec3(scattering));
        return media.media.size();
    };
    EXPECT_EQ(count(0.0F, 0.5F), 1U);
    EXPECT_EQ(count(0.5F, 0.0F), 2U);
    EXPECT_EQ(count(0.5F, 0.5F), 2U);
}

}  // namespace
}  // namespace glim
