#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace glim::cone_test {

constexpr double kPi = std::numbers::pi;

struct Case {
    float sin2;
    vec2 u;
    float oneMinusCos, pdf;
    vec2 across;
    float rise;
};

// 1 - cos of the half angle = 2 sin^2 of half of it; the cone's solid angle is 2 pi times that.
double riseOf(double sin2) { return 2.0 * std::pow(std::sin(0.5 * std::asin(std::sqrt(sin2))), 2.0); }

Case makeCase(float sin2, vec2 u)
{
    const double whole = riseOf(static_cast<double>(sin2)), rise = static_cast<double>(u.x) * whole;
    const double phi = kPi * (2.0 * static_cast<double>(u.y) - 1.0), r = std::sqrt(rise * (2.0 - rise));
    return {sin2,
            u,
            static_cast<float>(whole),
            static_cast<float>(1.0 / (2.0 * kPi * whole)),
            vec2(r * std::cos(phi), r * std::sin(phi)),
            static_cast<float>(rise)};
}

// Relative error of the density 1 / (2 pi (1 - cos)) with the cosine in float.
double naiveError(double ratio)
{
    const auto sin2 = static_cast<float>(ratio * ratio);
    const double naive = static_cast<double>(1.0F / (2.0F * std::numbers::pi_v<float> * (1.0F - std::sqrt(1.0F - sin2))));
    return std::abs(naive * 2.0 * kPi * riseOf(static_cast<double>(sin2)) - 1.0);
}

// Ratios of radius to distance from 1e-6 to 0.999999.
TEST(ConeTest, H11SmallConesAreAccurate)
{
    Random random(11);
    std::vector<Case> cases;
    const int count = static_cast<int>(hardTrials(200000));
    for (int i = 0; i < count; ++i) {
        const double ratio = i % 2 == 0 ? random.logUniform(1e-6, 1.0) : 1.0 - random.logUniform(1e-6, 1.0);
        cases.push_back(makeCase(static_cast<float>(ratio * ratio), {random.unitFloat(), random.unitFloat()}));
    }
    for (const float x : {0.0F, 0x1p-24F, 0.5F, 1.0F - 0x1p-24F}) {
        for (const float y : {0.0F, 0x1p-24F, 0.5F, 1.0F - 0x1p-24F}) {
            cases.push_back(makeCase(1e-12F, {x, y}));
            cases.push_back(makeCase(1.0F, {x, y}));
        }
    }
    KernelTest(test_kernels::cone_test).cases(cases).resultsOf<vec3>(cases.size()).run();
    printHardCase("H11", "cones of r/d 1e-6 to .999999", static_cast<double>(cases.size()), "density within 1e-6",
                  "1 - cos: off by " + figure(naiveError(1e-2)) + " at r/d 1e-2, " + figure(naiveError(1e-3)) + " at 1e-3, " +
                      figure(naiveError(1e-4)) + " at 1e-4");
}

// Equal solid angles get equal counts: rings of equal 1 - cos, sectors of equal azimuth.
void expectUniform(float sin2, std::uint64_t seed)
{
    constexpr int kRings = 10, kSectors = 20;
    Random random(seed);
    std::vector<Case> cases;
    for (int i = 0; i < 1000000; ++i) {
        cases.push_back(makeCase(sin2, {random.unitFloat(), random.unitFloat()}));
    }
    KernelTest test(test_kernels::cone_test);
    test.cases(cases).resultsOf<vec3>(cases.size()).run();
    std::vector<double> counts(kRings * kSectors, 0.0);
    for (const vec3& w : test.results<vec3>()) {
        const double r2 = glm::dot(glm::dvec2(w), glm::dvec2(w));
        const double rise = r2 / (1.0 + std::sqrt(1.0 - r2)) / riseOf(static_cast<double>(sin2));
        const double turn = 0.5 + std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)) / (2.0 * kPi);
        ++counts[static_cast<std::size_t>(std::min(kRings - 1, static_cast<int>(rise * kRings)) * kSectors +
                                          std::min(kSectors - 1, static_cast<int>(turn * kSectors)))];
    }
    const std::vector<double> expected(counts.size(), static_cast<double>(cases.size()) / kRings / kSectors);
    expectCounts("cone of sin^2 " + std::to_string(sin2), counts, expected, 2);
}

TEST(ConeTest, H11IsUniform)
{
    expectUniform(0.7F, 12);
    expectUniform(1e-8F, 15);
}

}  // namespace glim::cone_test
