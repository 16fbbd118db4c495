#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim::template_kernel_test {

// As in the kernel.
struct Case {
    float u;
    vec2 point;
};

TEST(TemplateKernelTest, IsWhatItShouldBe)
{
    std::vector<Case> cases;
    for (int i = 0; i < 1000; ++i) {
        const float u = static_cast<float>(i) / 1000.0F;
        const double angle = std::numbers::pi * (2.0 * static_cast<double>(u) - 1.0);
        cases.push_back({u, glm::dvec2(std::cos(angle), std::sin(angle))});
    }
    KernelTest(test_kernels::template_kernel_test).cases(cases).run();
}

}  // namespace glim::template_kernel_test
