#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

struct Case {
    vec2 u;
    vec2 disk;
};

// Shirley and Chiu's map by its definition: the square's concentric frames go to circles, arc length kept.
glm::dvec2 concentricDisk(glm::dvec2 u)
{
    const double a = 2.0 * u.x - 1.0, b = 2.0 * u.y - 1.0;
    if (a == 0.0 && b == 0.0) {
        return {0.0, 0.0};
    }
    const double radius = std::max(std::abs(a), std::abs(b));
    const double quarter = std::numbers::pi / 4.0;
    const double phi = std::abs(a) > std::abs(b) ? (a > 0 ? quarter * (b / a) : quarter * (4.0 + b / a))
                                                 : (b > 0 ? quarter * (2.0 - a / b) : quarter * (6.0 - a / b));
    return {radius * std::cos(phi), radius * std::sin(phi)};
}

TEST(WarpTest, HitsTheDiskSphereAndTriangle)
{
    std::vector<Case> cases;
    for (int i = 0; i <= 64; ++i) {
        for (int j = 0; j <= 64; ++j) {
            const vec2 u(std::min(static_cast<float>(i) / 64.0F, 1.0F - 0x1p-24F),
                         std::min(static_cast<float>(j) / 64.0F, 1.0F - 0x1p-24F));
            cases.push_back({u, vec2(concentricDisk(glm::dvec2(u)))});
        }
    }
    KernelTest(test_kernels::warp_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
