#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

struct Case {
    float cosine, cosInner, cosOuter;
    float falloff;
    float distance = 1.0F, range = 0.0F;
    float window = 1.0F;
};

// The falloff with a ramp of .001 at least, as KHR_lights_punctual suggests it.
float naiveFalloff(const Case& c)
{
    const float scale = 1.0F / std::max(0.001F, c.cosInner - c.cosOuter);
    const float ramp = std::clamp((c.cosine - c.cosOuter) * scale, 0.0F, 1.0F);
    return ramp * ramp;
}

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
    float worst = 0.0F;
    for (const Case& c : cases) {
        worst = std::max(worst, std::abs(naiveFalloff(c) - c.falloff));
    }
    printHardCase("H16", "spots from .2 degrees", static_cast<double>(cases.size()), "falloff within rounding",
                  "a ramp of at least .001: off by " + figure(static_cast<double>(worst)));
}

// KHR_lights_punctual: max(min(1 - (distance / range)^4, 1), 0), before the inverse square.
TEST(PunctualTest, RangeFalloff)
{
    std::vector<Case> cases;
    for (const float range : {1e-3F, 2.0F, 1e6F}) {
        for (int i = 0; i <= 40; ++i) {
            Case c{1.0F, 1.0F, 0.0F, 1.0F, 0.05F * static_cast<float>(i) * range, range, 0.0F};
            c.window =
                static_cast<float>(std::clamp(1.0 - std::pow(static_cast<double>(c.distance) / static_cast<double>(range), 4.0), 0.0, 1.0));
            cases.push_back(c);
        }
    }
    cases.push_back({1.0F, 1.0F, 0.0F, 1.0F, 1e10F});  // no range
    KernelTest(test_kernels::punctual_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
