#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim::punctual_test {

struct Case {
    vec3 a, b;           // unit
    float angle;         // between them, as a versine
    float inner, outer;  // versines
    float falloff;
    float distance = 1.0F, range = 0.0F;
    float window = 1.0F;
};

double versine(double angle) { return 2.0 * std::pow(std::sin(0.5 * angle), 2.0); }

// The falloff by cosines in float, with a ramp of .001 at least, as KHR_lights_punctual suggests it.
float naiveFalloff(const Case& c)
{
    const float cosInner = 1.0F - c.inner, cosOuter = 1.0F - c.outer;
    const float ramp = std::clamp((glm::dot(c.a, c.b) - cosOuter) / std::max(0.001F, cosInner - cosOuter), 0.0F, 1.0F);
    return ramp * ramp;
}

// KHR_lights_punctual: full inside the inner angle, nothing outside the outer one, the square of the share between. Rounding the two
// directions turns them by 1e-7 rad; the narrowest beam is .02 degrees wide.
TEST(PunctualTest, H16SpotFalloff)
{
    std::vector<Case> cases;
    const double turn = 0.7;
    for (const auto& [inner, outer] :
         {std::pair{0.0, 0.7854}, {0.3, 0.5}, {0.5, 0.9}, {0.2, 1.5}, {0.0, 0.0087}, {0.0035, 0.007}, {0.0, 2e-4}, {3e-4, 3.5e-4}}) {
        for (int i = 0; i <= 200; ++i) {
            const double angle = turn + 0.006 * outer * i;
            Case c{vec3(glm::dvec3(std::sin(turn), 0.0, std::cos(turn))), vec3(glm::dvec3(std::sin(angle), 0.0, std::cos(angle)))};
            const glm::dvec3 across = glm::dvec3(c.a) - glm::dvec3(c.b);
            c.angle = static_cast<float>(0.5 * glm::dot(across, across));
            c.inner = static_cast<float>(versine(inner));
            c.outer = static_cast<float>(versine(outer));
            const double share = (static_cast<double>(c.outer) - static_cast<double>(c.angle)) /
                                 (static_cast<double>(c.outer) - static_cast<double>(c.inner));
            c.falloff = static_cast<float>(std::pow(std::clamp(share, 0.0, 1.0), 2.0));
            cases.push_back(c);
        }
    }
    const vec3 x(1, 0, 0), y(0, 1, 0);
    cases.push_back({x, y, 1.0F, 1.0F, 1.0F, 0.0F});  // no ramp at all: nothing at or outside the rim, all inside
    cases.push_back({x, x, 0.0F, 1.0F, 1.0F, 1.0F});
    KernelTest(test_kernels::punctual_test).cases(cases).run();
    float worst = 0.0F;
    for (const Case& c : cases) {
        worst = std::max(worst, std::abs(naiveFalloff(c) - c.falloff));
    }
    printHardCase("H16", "spots from .02 degrees", static_cast<double>(cases.size()), "falloff within rounding",
                  "by cosines, a ramp of at least .001: off by " + figure(static_cast<double>(worst)));
}

// KHR_lights_punctual: max(min(1 - (distance / range)^4, 1), 0), before the inverse square.
TEST(PunctualTest, RangeFalloff)
{
    std::vector<Case> cases;
    for (const float range : {1e-3F, 2.0F, 1e6F}) {
        for (int i = 0; i <= 40; ++i) {
            Case c{vec3(1, 0, 0), vec3(1, 0, 0), 0.0F, 0.0F, 1.0F, 1.0F, 0.05F * static_cast<float>(i) * range, range, 0.0F};
            c.window =
                static_cast<float>(std::clamp(1.0 - std::pow(static_cast<double>(c.distance) / static_cast<double>(range), 4.0), 0.0, 1.0));
            cases.push_back(c);
        }
    }
    cases.push_back({vec3(1, 0, 0), vec3(1, 0, 0), 0.0F, 0.0F, 1.0F, 1.0F, 1e10F});  // no range
    KernelTest(test_kernels::punctual_test).cases(cases).run();
}

}  // namespace glim::punctual_test
