// Motions as kernels read them, against the host's in double.
#include "host/flatten/flatten_scene.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace glim::motion_test {

struct MotionCase {
    uint motion;
    float time;
    vec3 point;
    vec3 placed;
    float tolerance;
};

// As many keys as that, evenly in time but for a jump in the middle.
Motion randomMotion(Random& random, std::size_t count, double turn)
{
    Motion motion;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), 2.0 * random.normalVector());
        const glm::dmat4 turned = glm::rotate(shifted, turn * random.uniform(), random.direction());
        const glm::dvec3 scale(random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), random.uniform(0.5, 2.0));
        MotionKey key = splitTransform(glm::scale(turned, scale));
        key.time = static_cast<double>(count > 4 && i > count / 2 ? i - 1 : i) / static_cast<double>(count > 4 ? count - 2 : count - 1);
        key.rotation = i > 0 && glm::dot(motion.back().rotation, key.rotation) < 0.0 ? -key.rotation : key.rotation;
        motion.push_back(key);
    }
    return motion;
}

TEST(MotionKernelTest, IsWhereTheHostSays)
{
    Random random(3);
    Scene scene = makeTestScene(icosphere(0));
    scene.instances.clear();
    for (const std::size_t count : {2, 3, 7, 64}) {
        for (const double turn : {0.0, 1e-3, 0.5, 3.1}) {
            addInstance(scene, 0, {0, 0, 0}, 0.0, glm::dvec3(1.0));
            scene.instances.back().motion = std::make_shared<const Motion>(randomMotion(random, count, turn));
        }
    }
    const SceneOnDevice onDevice(scene);
    std::vector<MotionCase> cases;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const uint motion = onDevice.flat.instances[i * kInstanceTexels + 4].w;
        for (int k = 0; k < 64; ++k) {
            const float time = k == 0 ? 0.0F : k == 1 ? 1.0F : random.unitFloat();
            const glm::dvec3 point = random.normalVector();
            const glm::dvec3 placed(transformAt(*scene.instances[i].motion, static_cast<double>(time)) * glm::dvec4(point, 1.0));
            // Times of keys are rounded too: by 2^-24 of the shutter, in which things go a few metres, 64 times faster between 64 keys.
            const double speed = static_cast<double>(scene.instances[i].motion->size());
            cases.push_back({motion, time, glm::vec3(point), glm::vec3(placed),
                             static_cast<float>((2e-6 + 1e-6 * speed) * (3.0 + glm::length(point)))});
        }
    }
    KernelTest test = onDevice.test(test_kernels::motion_test);
    test.cases(cases).run();
}

}  // namespace glim::motion_test
