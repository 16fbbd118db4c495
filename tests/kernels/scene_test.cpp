#include "test_kernels.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

struct Case {
    uint record;
    uint id;
    uint sphere;
    vec3 corners[3];
    vec3 normals[3];
    uint sliver;
    uint material;
    vec3 baseColor;
    vec3 emission;
    uint light;
    vec3 cameraPosition;
};

constexpr std::uint32_t kSliver = 7, kNearlySliver = 8;

// A flat and a smooth primitive, of which the second emits and has triangles in pieces, and spheres that emit every other one.
Scene makeScene()
{
    Scene scene = sceneOf(strips(8, 1), randomSpheres(20, 0.2F, 2));
    const auto half = static_cast<std::uint32_t>(scene.triangles.size() / 2);
    scene.triangles[kSliver] = {{glm::vec3(0.0F), glm::vec3(0.5F, 0.99F * kSliverHeight, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)}};
    scene.triangles[kNearlySliver] = {{glm::vec3(0.0F), glm::vec3(0.5F, 1.01F * kSliverHeight, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)}};
    scene.materials.resize(3);
    scene.materials[1].baseColor = glm::vec3(0.1F, 0.2F, 0.3F);
    scene.materials[1].emission = glm::vec3(1.0F, 2.0F, 3.0F);
    scene.materials[2].emission = glm::vec3(5.0F, 4.0F, 3.0F);
    scene.primitives = {{"", 0, half, 0, false}, {"", half, half, 1, true}};
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const float angle = static_cast<float>(i);
        scene.normals.push_back({{glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::vec3(std::cos(angle), 0, std::sin(angle))}});
    }
    for (std::size_t i = 0; i < scene.spheres.size(); i += 2) {
        scene.spheres[i].material = 2;
    }
    return scene;
}

Case caseOf(const Scene& scene, std::uint32_t id)
{
    Case c{};
    c.id = id;
    const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
    if (id < triangles) {
        const bool second = id >= scene.primitives[1].firstTriangle;
        std::copy_n(scene.triangles[id].vertices, 3, c.corners);
        if (second) {
            std::copy_n(scene.normals[id].normals, 3, c.normals);
        }
        c.sliver = id == kSliver ? 1 : 0;
        c.material = second ? 1 : 0;
        c.light = second ? 1 : 0;
    } else {
        const Sphere& sphere = scene.spheres[id - triangles];
        c.sphere = 1;
        c.corners[0] = sphere.center;
        c.corners[1] = vec3(sphere.radius, 0.0F, 0.0F);
        c.material = sphere.material;
        c.light = sphere.material == 2 ? 2 + (id - triangles) / 2 : 0;  // after the mesh's one light
    }
    c.baseColor = scene.materials[c.material].baseColor;
    c.emission = scene.materials[c.material].emission;
    return c;
}

TEST(SceneTest, IsOnTheDeviceAsItWasMade)
{
    const Scene scene = makeScene();
    Camera camera;
    camera.position = glm::vec3(1.0F, 2.0F, 3.0F);
    const SceneOnDevice onDevice(scene, camera);
    std::vector<Case> cases;
    for (std::uint32_t record = 0; record < onDevice.bvh.order.size(); ++record) {
        cases.push_back(caseOf(scene, onDevice.bvh.order[record]));
        cases.back().record = record;
        cases.back().cameraPosition = camera.position;
    }
    EXPECT_GT(cases.size(), scene.triangles.size() + scene.spheres.size()) << "some have several records";
    onDevice.test(test_kernels::scene_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
