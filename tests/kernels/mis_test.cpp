#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glim {
namespace {

struct Case {
    float f, g, weight;
};

// Veach's power heuristic as written: double holds the squares of all floats.
float powerHeuristic(float f, float g)
{
    if (std::isinf(f) && std::isinf(g)) {
        return 0.5F;
    }
    if (std::isinf(f) || std::isinf(g)) {
        return std::isinf(f) ? 1.0F : 0.0F;
    }
    const double f2 = static_cast<double>(f) * static_cast<double>(f), g2 = static_cast<double>(g) * static_cast<double>(g);
    return f2 == 0.0 ? 0.0F : static_cast<float>(f2 / (f2 + g2));
}

// H22.
TEST(MisTest, WeightsAddUpToOne)
{
    std::vector<Case> cases;
    const float largest = std::numeric_limits<float>::max(), infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> densities = {0.0F, 1.2e-38F, 1.0F, 1e19F, 1e30F, largest, infinity};
    for (const float f : densities) {
        for (const float g : densities) {
            cases.push_back({f, g, powerHeuristic(f, g)});
        }
    }
    Random random(20);
    for (int i = 0; i < 500000; ++i) {
        const float f = static_cast<float>(random.logUniform(1e-30, 1e30));
        const float g = static_cast<float>(static_cast<double>(f) * random.logUniform(1e-8, 1e8));
        cases.push_back({f, g, powerHeuristic(f, g)});
    }
    KernelTest(test_kernels::mis_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
