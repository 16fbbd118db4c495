// A point is connected to the camera by the ray that sees it, and weighs as much as the film that its surroundings cover.
#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/any_camera.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

struct Case {
    FlatCamera camera;
    vec2 film, disk;
    vec3 p, wo;
    float weight;
};

struct Ray {
    glm::dvec3 origin, direction;
};

// As lensRay of shaders/lib/camera.glsl, in double.
Ray rayOf(const FlatCamera& camera, const glm::dvec2& film, const glm::dvec2& disk)
{
    const glm::dvec3 across = film.x * glm::dvec3(camera.right) + film.y * glm::dvec3(camera.up);
    const glm::dvec3 aperture = disk.x * glm::dvec3(camera.lensRight) + disk.y * glm::dvec3(camera.lensUp);
    const bool orthographic = camera.kind == kOrthographic;
    const glm::dvec3 turn = (orthographic ? glm::dvec3(0.0) : across) - aperture * static_cast<double>(camera.inverseFocus);
    return {glm::dvec3(camera.position) + aperture + (orthographic ? across : glm::dvec3(0.0)),
            glm::normalize(glm::dvec3(camera.forward) + turn)};
}

// Where the ray of a film point meets the plane through p across wo.
glm::dvec3 meets(const FlatCamera& camera, const glm::dvec2& film, const glm::dvec2& disk, const glm::dvec3& p, const glm::dvec3& wo)
{
    const Ray ray = rayOf(camera, film, disk);
    return ray.origin + ray.direction * (glm::dot(p - ray.origin, wo) / glm::dot(ray.direction, wo));
}

TEST(CameraConnectionTest, IsTheRayThatSeesThePoint)
{
    Random random(81);
    std::vector<Case> cases;
    for (int i = 0; i < 20000; ++i) {
        Camera camera = anyCamera(random);
        camera.position *= 1.0F / std::max(1.0F, glm::length(camera.position));
        camera.yfov = static_cast<float>(random.uniform(0.2, 2.0));
        if (i % 2 == 0) {
            camera.kind = Camera::Kind::Orthographic;
            camera.halfHeight = static_cast<float>(random.uniform(0.5, 3.0));
        }
        const Lens lens{i % 3 == 0 ? 0.0F : static_cast<float>(random.uniform(0.01, 0.3)), static_cast<float>(random.uniform(0.5, 5.0))};
        Case c{};
        c.camera = flattenCamera(camera, static_cast<float>(random.uniform(0.5, 2.0)), lens);
        c.film = vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        c.disk = 0.7F * vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const Ray ray = rayOf(c.camera, c.film, c.disk);
        const glm::dvec3 p = ray.origin + ray.direction * random.uniform(0.5, 5.0);
        c.p = p;
        c.wo = -ray.direction;
        constexpr double kStep = 1e-4;
        const auto side = [&](const glm::dvec2& step) {
            return (meets(c.camera, glm::dvec2(c.film) + step, c.disk, p, ray.direction) -
                    meets(c.camera, glm::dvec2(c.film) - step, c.disk, p, ray.direction)) /
                   (2.0 * kStep);
        };
        // The film is 2 by 2.
        c.weight = static_cast<float>(1.0 / (4.0 * glm::length(glm::cross(side({kStep, 0.0}), side({0.0, kStep})))));
        cases.push_back(c);
    }
    KernelTest(test_kernels::camera_connection_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
