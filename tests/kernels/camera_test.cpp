#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

struct Case {
    FlatCamera camera;
    vec2 position;
    vec2 size;
    vec3 origin;
    vec3 direction;
    float tolerance;
};

Camera tilted()
{
    Camera camera;
    camera.position = {1.0F, 2.0F, -3.0F};
    camera.forward = glm::normalize(glm::vec3(0.3F, -0.2F, 0.9F));
    camera.right = glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward);
    return camera;
}

std::vector<Case> casesFor(const Camera& camera, const vec2& size, double halfHeight, double tolerance)
{
    std::vector<Case> cases;
    const double aspect = static_cast<double>(size.x / size.y);
    for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) {
            const vec2 position(size.x * static_cast<float>(i) / 8.0F, size.y * static_cast<float>(j) / 8.0F);
            const double right = (static_cast<double>(i) / 4.0 - 1.0) * halfHeight * aspect;
            const double up = (1.0 - static_cast<double>(j) / 4.0) * halfHeight;  // row 0 is at the top
            const glm::dvec3 across = right * glm::dvec3(camera.right) + up * glm::dvec3(camera.up);
            const glm::dvec3 position3(camera.position), forward(camera.forward);
            const bool perspective = camera.kind == Camera::Kind::Perspective;
            cases.push_back({flattenCamera(camera, static_cast<float>(aspect)), position, size,
                             vec3(perspective ? position3 : position3 + across),
                             vec3(perspective ? glm::normalize(forward + across) : forward),
                             static_cast<float>(tolerance)});
        }
    }
    return cases;
}

TEST(CameraTest, Perspective)
{
    Camera camera = tilted();
    camera.yfov = 0.8F;
    KernelTest(test_kernels::camera_test).cases(casesFor(camera, {640, 480}, std::tan(0.4), 5e-7)).run();
}

TEST(CameraTest, Orthographic)
{
    Camera camera = tilted();
    camera.kind = Camera::Kind::Orthographic;
    camera.halfWidth = 4.0F;
    camera.halfHeight = 3.0F;
    KernelTest(test_kernels::camera_test).cases(casesFor(camera, {640, 480}, 3.0, 5e-7)).run();
}

// H35: a field of view of 0.1 degree over 1,920 pixels: within .07 pixel of the double computation.
TEST(CameraTest, H35ThinFieldOfView)
{
    const double fov = 0.1 * std::numbers::pi / 180.0;
    Camera camera;
    camera.yfov = static_cast<float>(fov);
    KernelTest(test_kernels::camera_test).cases(casesFor(camera, {1920, 1920}, std::tan(0.5 * fov), 0.07 * fov / 1920)).run();
}

}  // namespace
}  // namespace glim
