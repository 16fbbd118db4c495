#include "test_kernels.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim::scene_test {

struct Case {
    uint primitiveRef;
    uint id;
    uint triangle;
    vec3 corners[3];
    vec3 normals[3];
    uint sliver;
    uint material;
    vec3 baseColor;
    vec3 emission;
    uint emits;
    vec3 cameraPosition;
};

constexpr std::uint32_t kSliver = 7, kNearlySliver = 8;

glm::vec3 cornerNormal(std::size_t corner)
{
    const float angle = static_cast<float>(corner);
    return corner % 3 == 0 ? glm::vec3(0, 1, 0) : glm::vec3(std::cos(angle), 0, std::sin(angle));
}

// A flat and a smooth mesh, of which the second emits and has triangles in pieces, and spheres that emit every other one.
Scene makeScene()
{
    Triangles first = strips(8, 1);
    const Triangles second(first.begin() + static_cast<std::ptrdiff_t>(first.size() / 2), first.end());
    first.resize(first.size() / 2);
    first[kSliver] = {{glm::vec3(0.0F), glm::vec3(0.5F, 0.99F * kSliverHeight, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)}};
    first[kNearlySliver] = {{glm::vec3(0.0F), glm::vec3(0.5F, 1.01F * kSliverHeight, 0.0F), glm::vec3(1.0F, 0.0F, 0.0F)}};
    Scene scene = makeTestScene(first, randomSpheres(20, 0.2F, 2));
    scene.materials.resize(3);
    scene.materials[1].baseColor = glm::vec3(0.1F, 0.2F, 0.3F);
    scene.materials[1].emission = glm::vec3(1.0F, 2.0F, 3.0F);
    scene.materials[2].emission = glm::vec3(5.0F, 4.0F, 3.0F);
    std::vector<glm::vec3> normals;
    for (std::size_t i = 0; i < 3 * second.size(); ++i) {
        normals.push_back(cornerNormal(i));
    }
    addMesh(scene, second, 1, normals);
    for (std::size_t i = 0; i < scene.spheres.size(); i += 2) {
        scene.spheres[i].material = 2;
    }
    return scene;
}

Case makeCase(const Scene& scene, const Primitives& primitives, std::uint32_t id)
{
    Case c{};
    c.id = id;
    const auto triangles = static_cast<std::uint32_t>(primitives.triangles.size());
    c.triangle = id < triangles ? 1 : 0;
    if (id < triangles) {
        const std::uint32_t mesh = primitives.findInstance(id);
        std::copy_n(primitives.triangles[id].vertices, 3, c.corners);
        for (std::size_t v = 0; mesh == 1 && v < 3; ++v) {
            const glm::dvec3 normal(cornerNormal(3 * (id - primitives.firstTriangles[1]) + v));
            c.normals[v] = glm::vec3(normal / glm::length(normal));
        }
        c.sliver = id == kSliver ? 1 : 0;
        c.material = mesh;
        c.emits = mesh;
    } else {
        const Sphere& sphere = scene.spheres[id - triangles];
        c.corners[0] = sphere.center;
        c.corners[1] = vec3(sphere.radius, 0.0F, 0.0F);
        c.material = sphere.material;
        c.emits = sphere.material == 2 ? 1 : 0;
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
    for (std::uint32_t ref = 0; ref < onDevice.bvh.order.size(); ++ref) {
        cases.push_back(makeCase(scene, onDevice.primitives, onDevice.bvh.order[ref]));
        cases.back().primitiveRef = ref;
        cases.back().cameraPosition = camera.position;
    }
    EXPECT_GT(cases.size(), onDevice.primitives.count()) << "some have several references";
    onDevice.test(test_kernels::scene_test).cases(cases).run();
}

}  // namespace glim::scene_test
