// Spheres left from outside and inside, by reflection and by refraction, from 1e-3 to 1e5 in size.
#include "test_kernels.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

namespace glim::leave_sphere_test {

TEST(LeaveSphereTest, RaysOutwardsNeverReturnAndRaysInwardsCrossIt)
{
    for (const float radius : {1.0F, 1e-3F, 1e5F}) {
        std::vector<Sphere> spheres;
        for (int i = -2; i <= 2; ++i) {
            spheres.push_back({"", glm::vec3(5.0F * radius * static_cast<float>(i), radius, -radius), radius, 0});
        }
        const SceneOnDevice scene(makeTestScene({}, spheres));
        scene.test(test_kernels::leave_sphere_test).threads(samplesFor(200'000, 20) / 64 * 64).run();
    }
}

}  // namespace glim::leave_sphere_test
