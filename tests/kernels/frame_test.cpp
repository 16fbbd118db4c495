#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

struct Case {
    vec3 normal, vector, unit;
};

Case caseOf(const glm::dvec3& normal, Random& random)
{
    const glm::dvec3 d = random.direction();
    Case c{normal, random.logUniform(1e-30, 1e30) * d, {}};
    const glm::dvec3 v(c.vector);
    c.unit = v / glm::length(v);
    return c;
}

// H17 and H39: any direction, directions within 1e-7 to 1e-3 of both poles, and the axes with zeros of either sign.
TEST(FrameTest, IsOrthonormalAndRightHanded)
{
    for (int round = 0; round < testRounds(); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 7 + 13);
        std::vector<Case> cases;
        for (int i = 0; i < 1000000; ++i) {
            cases.push_back(caseOf(random.direction(), random));
        }
        for (int i = 0; i < 100000; ++i) {
            const glm::dvec2 side = glm::normalize(glm::dvec2(random.normal(), random.normal()));
            const glm::dvec3 near(side * random.logUniform(1e-7, 1e-3), i % 2 == 0 ? 1.0 : -1.0);
            cases.push_back(caseOf(glm::normalize(near), random));
        }
        for (int i = 0; i < 24; ++i) {
            const double zero = (i & 1) != 0 ? -0.0 : 0.0, other = (i & 2) != 0 ? -0.0 : 0.0;
            glm::dvec3 n(zero, other, zero);
            n[i / 8] = (i & 4) != 0 ? -1.0 : 1.0;
            cases.push_back(caseOf(n, random));
        }
        KernelTest(test_kernels::frame_test).cases(cases).run();
    }
}

}  // namespace
}  // namespace glim
