#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim::mis_test {

struct Case {
    float f, g;
    float weight;
};

// H22: f^2 / (f^2 + g^2) in long double, over values whose squares leave float's range. 1e-38 is denormal and counts as 0.
TEST(MisTest, H22PowerHeuristicNeverOverflows)
{
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> pdfs = {0.0F, 1e-38F, 0x1p-126F, 2e-38F, 1e-20F, 0.3F, 1.0F, 7.0F, 1e19F, 1e30F, 3.4028235e38F, infinity};
    std::vector<Case> cases;
    for (const float f : pdfs) {
        for (const float g : pdfs) {
            const long double a = std::fpclassify(f) == FP_SUBNORMAL ? 0.0L : f, b = std::fpclassify(g) == FP_SUBNORMAL ? 0.0L : g;
            long double weight = a * a / (a * a + b * b);
            if (a == 0.0L) {
                weight = 0.0L;
            } else if (std::isinf(f)) {
                weight = std::isinf(g) ? 0.5L : 1.0L;
            } else if (std::isinf(g)) {
                weight = 0.0L;
            }
            cases.push_back({f, g, static_cast<float>(weight)});
        }
    }
    KernelTest(test_kernels::mis_test).cases(cases).run();
    printHardCase("H22", "pdfs 0, 1e-38 ... 3.4e38, infinity", static_cast<double>(cases.size()), "all right");
}

}  // namespace glim::mis_test
