#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim {
namespace {

struct Case {
    vec3 contribution;
    std::uint32_t events;
    float limit;
    vec3 kept;
    float removed;
};

TEST(ClampIndirectTest, SaysWhatItTook)
{
    Random random(91);
    std::vector<Case> cases;
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 mix(random.uniform(), random.uniform(), random.uniform());
        Case c{random.logUniform(1e-10, 1e10) * mix, random.below(4), 0.0F, {}, 0.0F};
        c.limit = static_cast<float>(random.logUniform(1e-6, 1e6));
        const glm::dvec3 light(c.contribution);
        const double largest = std::max({light.r, light.g, light.b}), limit = static_cast<double>(c.limit);
        // Light that has met fewer than two surfaces is direct. The hue stays.
        const double share = c.events >= 2 && largest > limit ? limit / largest : 1.0;
        c.kept = light * share;
        c.removed = static_cast<float>((light.r + light.g + light.b) / 3.0 * (1.0 - share));
        cases.push_back(c);
    }
    KernelTest(test_kernels::clamp_indirect_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
