#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glim {
namespace {

struct Case {
    vec3 normal;
    vec3 vector;
    vec3 unit;
};

// H17: 1e5 normals anywhere and 1e5 within 1e-3 to 1e-7 rad of +-z, where Frisvad's frame fails, and the poles with both
// zeros. H39: vectors of 1e-30 to 1e30.
TEST(FrameTest, H17H39OrthonormalEverywhere)
{
    std::mt19937 random(7);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> uniform;
    std::vector<Case> cases;
    const auto add = [&](const glm::dvec3& n) {
        const glm::dvec3 v(gauss(random), gauss(random), gauss(random));
        const vec3 scaled(v * std::pow(10.0, 60.0 * uniform(random) - 30.0));
        cases.push_back({vec3(glm::normalize(n)), scaled, vec3(glm::normalize(glm::dvec3(scaled)))});
    };
    for (int i = 0; i < 100000; ++i) {
        add({gauss(random), gauss(random), gauss(random)});
        const double angle = std::pow(10.0, -3.0 - 4.0 * uniform(random)), phi = 6.28 * uniform(random);
        add({angle * std::cos(phi), angle * std::sin(phi), i % 2 == 0 ? 1.0 : -1.0});
    }
    for (const float z : {1.0F, -1.0F}) {
        for (const float zero : {0.0F, -0.0F}) {
            cases.push_back({{zero, zero, z}, {zero, 3.0F, zero}, {0, 1, 0}});
            cases.push_back({{zero, z, zero}, {1e-30F, zero, zero}, {1, 0, 0}});
        }
    }
    KernelTest(test_kernels::frame_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
