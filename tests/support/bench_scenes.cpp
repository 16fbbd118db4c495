#include "tests/support/bench_scenes.hpp"

#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <cmath>

namespace glim {
namespace {

glm::vec3 bump(const glm::vec3& v)
{
    const float height = std::sin(9.0F * v.x) * std::sin(11.0F * v.y + 1.0F) * std::sin(8.0F * v.z + 2.0F) +
                         0.3F * std::sin(31.0F * v.x + 2.0F) * std::sin(37.0F * v.z);
    return v * (0.55F + 0.12F * height);
}

SceneBuilder meadow()
{
    SceneBuilder builder;
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(20.0F));
    builder.quad({glm::vec3(-4, 14, -4), {4, 14, -4}, {4, 14, 4}, {-4, 14, 4}}, lamp)
        .environment(glm::vec3(0.5F))
        .perspective({-9, 6, 11}, {0, 0.5F, 0}, 0.7F);
    return builder;
}

}  // namespace

Scene bumpyBall(int subdivisions)
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(12.0F));
    builder.cube(1.0F, white, true)
        .quad({glm::vec3(-0.4F, 0.98F, -0.4F), {0.4F, 0.98F, -0.4F}, {0.4F, 0.98F, 0.4F}, {-0.4F, 0.98F, 0.4F}}, lamp)
        .perspective({0, 0, 0.99F}, {0, 0, 0}, 1.4F);
    Scene scene = builder.scene();
    Triangles ball = icosphere(subdivisions);
    for (Triangle& triangle : ball) {
        for (glm::vec3& v : triangle.vertices) {
            v = bump(v);
        }
    }
    addMesh(scene, ball, white);
    return scene;
}

Scene forest(int trees)
{
    SceneBuilder builder = meadow();
    const auto white = builder.lambert(glm::vec3(0.5F), glm::vec3(0.0F), true);
    builder.quad({glm::vec3(-10, 0, 10), {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}}, white);
    Scene scene = builder.scene();
    Random random(5);
    Triangles leaves;
    for (int tree = 0; tree < trees; ++tree) {
        const glm::dvec3 top(random.uniform(-10.0, 10.0), random.uniform(0.6, 1.2), random.uniform(-10.0, 10.0));
        for (int leaf = 0; leaf < 1000; ++leaf) {
            const glm::dvec3 at = top + 0.22 * glm::dvec3(1.0, 1.8, 1.0) * random.normalVector();
            Triangle triangle{};
            for (glm::vec3& v : triangle.vertices) {
                v = glm::vec3(at + 0.03 * random.normalVector());
            }
            leaves.push_back(triangle);
        }
    }
    addMesh(scene, leaves, white);
    return scene;
}

}  // namespace glim
