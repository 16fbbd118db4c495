#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace glim::frame_test {

struct Case {
    vec3 normal, vector, unit;
};

Case makeCase(const glm::dvec3& normal, Random& random)
{
    const glm::dvec3 d = random.direction();
    Case c{normal, random.logUniform(1e-30, 1e30) * d, {}};
    const glm::dvec3 v(c.vector);
    c.unit = v / glm::length(v);
    return c;
}

// Frisvad, "Building an Orthonormal Basis from a 3D Unit Vector Without Normalization", 2012: the largest of the dot products of the
// axes that should be 1 or 0.
double frisvadError(const vec3& n)
{
    vec3 x(0.0F, -1.0F, 0.0F), y(-1.0F, 0.0F, 0.0F);
    if (n.z >= -0.9999999F) {
        const float a = 1.0F / (1.0F + n.z), b = -n.x * n.y * a;
        x = {1.0F - n.x * n.x * a, b, -n.x};
        y = {b, 1.0F - n.y * n.y * a, -n.y};
    }
    const std::array<float, 5> errors = {glm::dot(x, x) - 1.0F, glm::dot(y, y) - 1.0F, glm::dot(x, y), glm::dot(y, n), glm::dot(n, x)};
    double worst = 0.0;
    for (const float error : errors) {
        worst = std::max(worst, std::abs(static_cast<double>(error)));
    }
    return worst;
}

bool isUnit(const vec3& v)
{
    const double length = glm::length(glm::dvec3(v));
    return std::abs(length - 1.0) <= 4e-7;
}

void printCases(const std::vector<Case>& cases)
{
    double worst = 0.0;
    std::size_t notUnit = 0;
    for (const Case& c : cases) {
        worst = std::max(worst, frisvadError(c.normal));
        notUnit += isUnit(c.vector / std::sqrt(glm::dot(c.vector, c.vector))) ? 0 : 1;
    }
    printHardCase("H17", "frames, near the poles too", static_cast<double>(cases.size()), "orthonormal within 5e-7",
                  "Frisvad: off by " + figure(worst));
    printHardCase("H39", "vectors of length 1e-30 to 1e30", static_cast<double>(cases.size()), "unit within 4e-7",
                  "v / |v|: " + std::to_string(notUnit) + " not unit");
}

// Any direction, directions within 1e-7 to 1e-3 of both poles, and the axes with zeros of either sign.
TEST(FrameTest, H17H39IsOrthonormalAndRightHanded)
{
    for (int round = 0; round < hardRounds(1100024); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 7 + 13);
        std::vector<Case> cases;
        for (int i = 0; i < 1000000; ++i) {
            cases.push_back(makeCase(random.direction(), random));
        }
        for (int i = 0; i < 100000; ++i) {
            const glm::dvec2 side = glm::normalize(glm::dvec2(random.normal(), random.normal()));
            const glm::dvec3 near(side * random.logUniform(1e-7, 1e-3), i % 2 == 0 ? 1.0 : -1.0);
            cases.push_back(makeCase(glm::normalize(near), random));
        }
        for (int i = 0; i < 24; ++i) {
            const double zero = (i & 1) != 0 ? -0.0 : 0.0, other = (i & 2) != 0 ? -0.0 : 0.0;
            glm::dvec3 n(zero, other, zero);
            n[i / 8] = (i & 4) != 0 ? -1.0 : 1.0;
            cases.push_back(makeCase(n, random));
        }
        KernelTest(test_kernels::frame_test).cases(cases).run();
        if (round == 0) {
            printCases(cases);
        }
    }
}

}  // namespace glim::frame_test
