#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

struct Case {
    float cosine, cosInner, cosOuter;
    float falloff;
};

// KHR_lights_punctual: full inside the inner angle, nothing outside the outer one, the square of the share between.
TEST(PunctualTest, H16SpotFalloff)
{
    std::vector<Case> cases;
    for (const auto& [inner, outer] : {std::pair{0.0, 0.7854}, {0.3, 0.5}, {0.5, 0.9}, {0.2, 1.5}, {0.0, 0.0087}, {0.0035, 0.007}}) {
        for (int i = 0; i <= 200; ++i) {
            Case c{static_cast<float>(std::cos(0.006 * outer * i)), static_cast<float>(std::cos(inner)),
                   static_cast<float>(std::cos(outer)), 0.0F};
            const double share = (static_cast<double>(c.cosine) - static_cast<double>(c.cosOuter)) /
                                 (static_cast<double>(c.cosInner) - static_cast<double>(c.cosOuter));
            c.falloff = static_cast<float>(std::pow(std::clamp(share, 0.0, 1.0), 2.0));
            cases.push_back(c);
        }
    }
    cases.push_back({0.5F, 0.5F, 0.5F, 0.0F});  // no ramp at all: nothing at or outside the rim, all inside
    cases.push_back({0.6F, 0.5F, 0.5F, 1.0F});
    KernelTest(test_kernels::punctual_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
