#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace glim::clamp_indirect_test {

struct Case {
    vec3 contribution;
    uint pathLength;
    float limit;
    vec3 kept;
    float removed;
};

TEST(ClampIndirectTest, KeepsTheHueAndCountsTheRest)
{
    std::mt19937 random(1);
    std::lognormal_distribution<float> value(0.0F, 3.0F);
    std::vector<Case> cases;
    for (uint i = 0; i < 4096; ++i) {
        Case c{{value(random), value(random), value(random)}, i % 5, value(random), vec3(0.0F), 0.0F};
        const glm::dvec3 all(c.contribution);
        const double largest = std::max({all.r, all.g, all.b});
        const double share = c.pathLength >= 2 ? std::min(1.0, static_cast<double>(c.limit) / largest) : 1.0;
        c.kept = vec3(all * share);
        c.removed = static_cast<float>((all.r + all.g + all.b) / 3.0 * (1.0 - share));
        cases.push_back(c);
    }
    KernelTest(test_kernels::clamp_indirect_test).cases(cases).run();
}

}  // namespace glim::clamp_indirect_test
