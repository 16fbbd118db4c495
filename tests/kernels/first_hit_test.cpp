#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

namespace glim::first_hit_test {

struct Case {
    vec3 point, ns, baseColor;
    float depth, tolerance;
};

// Metres along the camera's axis, not along the ray.
TEST(FirstHitTest, IsWhatTheCameraSaw)
{
    Random random(11);
    for (const double scale : {1.0, 1e-3, 1e4}) {
        Camera camera;
        camera.position = scale * random.normalVector();
        camera.forward = random.direction();
        const SceneOnDevice scene(makeTestScene(icosphere(0)), camera);
        std::vector<Case> cases;
        for (int i = 0; i < 1000; ++i) {
            Case c{scale * random.normalVector(), random.direction(), {random.uniform(), random.uniform(), random.uniform()}, 0, 0};
            const glm::dvec3 along = glm::dvec3(c.point) - glm::dvec3(camera.position), forward(camera.forward);
            c.depth = static_cast<float>(glm::dot(along, forward));
            // A difference, a product and two sums: half an ulp each of the terms, and the rounding of the expected value.
            c.tolerance = static_cast<float>(5.0 * 0x1p-24 * glm::dot(glm::abs(along), glm::abs(forward)));
            cases.push_back(c);
        }
        scene.test(test_kernels::first_hit_test).cases(cases).run();
    }
}

}  // namespace glim::first_hit_test
