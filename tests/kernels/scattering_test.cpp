// Scattering in a medium: distances, directions and what one channel's choice makes of the others.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::scattering_test {

using glm::dvec3;
using glm::vec4;

struct Case {
    vec3 throughput, extinction, albedo;
    float t, anisotropy;
    vec3 direction, u, scattered, reached;
};

double sum(const dvec3& v) { return v.x + v.y + v.z; }

vec3 randomColor(Random& random) { return {random.unitFloat(), random.unitFloat(), random.unitFloat()}; }

Case makeCase(Random& random, float anisotropy)
{
    Case c{};
    c.throughput = randomColor(random) + vec3(1e-3F);
    c.throughput[static_cast<int>(random.below(3))] *= random.below(2) == 0 ? 0.0F : 1.0F;
    c.extinction = 10.0F * randomColor(random) + vec3(1e-3F);
    c.albedo = randomColor(random);
    c.t = 2.0F * random.unitFloat();
    c.anisotropy = anisotropy;
    c.direction = vec3(random.direction());
    c.u = randomColor(random);
    // Of a channel that is chosen with its share of the throughput: value over the mean density of the channels.
    const dvec3 throughput = c.throughput, extinction = c.extinction, left = glm::exp(-extinction * static_cast<double>(c.t));
    const dvec3 share = throughput / sum(throughput);
    c.scattered = throughput * dvec3(c.albedo) * extinction * left / sum(share * extinction * left);
    c.reached = throughput * left / sum(share * left);
    return c;
}

// The share of deflections with a cosine below x: the integral of Henyey and Greenstein's function.
double shareBelow(double x, double g)
{
    if (g == 0.0) {
        return 0.5 * (1.0 + x);
    }
    return (1.0 - g * g) / (2.0 * g) * (1.0 / std::sqrt(1.0 + g * g - 2.0 * g * x) - 1.0 / (1.0 + g));
}

class ScatteringTest : public testing::TestWithParam<float> {};

TEST_P(ScatteringTest, DistancesAndDirectionsHaveTheirDensities)
{
    constexpr int kCount = 200000, kCells = 50;
    const double g = static_cast<double>(GetParam());
    Random random(7);
    std::vector<Case> cases;
    for (int i = 0; i < kCount; ++i) {
        cases.push_back(makeCase(random, GetParam()));
    }
    KernelTest test(test_kernels::scattering_test);
    test.cases(cases).resultsOf<vec4>(cases.size()).run();
    std::vector<double> cosines(kCells), lengths(kCells), expectedCosines, expectedLengths(kCells, static_cast<double>(kCount) / kCells);
    std::vector<double> deflections;
    double mostOff = 0.0;  // densities, relative to the integral's slope
    const auto cell = [](double share) { return static_cast<std::size_t>(std::clamp(share, 0.0, 0.999999) * kCells); };
    for (const vec4& result : test.results<vec4>()) {
        ++cosines[cell(0.5 * (1.0 + static_cast<double>(result.x)))];
        ++lengths[cell(-std::expm1(-2.0 * static_cast<double>(result.y)))];
        deflections.push_back(static_cast<double>(result.x));
        const double x = deflections.back(), step = 1e-5;
        const double slope = (shareBelow(x + step, g) - shareBelow(x - step, g)) / (2.0 * step);
        mostOff = std::max(mostOff, std::abs(2.0 * std::numbers::pi * static_cast<double>(result.w) / slope - 1.0));
    }
    for (int i = 0; i < kCells; ++i) {
        const double low = 2.0 * i / kCells - 1.0, high = 2.0 * (i + 1) / kCells - 1.0;
        expectedCosines.push_back(kCount * (shareBelow(high, g) - shareBelow(low, g)));
    }
    expectCounts("cosines of deflections", cosines, expectedCosines, 8);
    expectCounts("free paths, by the share that is shorter", lengths, expectedLengths, 8);
    expectSampleMean("mean cosine", deflections, g, 8);
    EXPECT_LT(mostOff, 1e-4) << "of the densities of deflections";
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, ScatteringTest, testing::Values(0.0F, -0.5F, 1e-4F, 0.8F));

// A channel is chosen as often as it has throughput.
TEST(ScatteringChannelTest, AreChosenByTheirThroughput)
{
    constexpr int kCount = 100000;
    Random random(8);
    std::vector<Case> cases;
    for (int i = 0; i < kCount; ++i) {
        Case c = makeCase(random, 0.0F);
        c.throughput = vec3(0.5F, 0.25F, 1.25F);
        const dvec3 throughput = c.throughput, extinction = c.extinction, left = glm::exp(-extinction * static_cast<double>(c.t));
        c.scattered = throughput * dvec3(c.albedo) * extinction * left * sum(throughput) / sum(throughput * extinction * left);
        c.reached = throughput * left * sum(throughput) / sum(throughput * left);
        cases.push_back(c);
    }
    KernelTest test(test_kernels::scattering_test);
    test.cases(cases).resultsOf<vec4>(cases.size()).run();
    std::vector<double> counts(3);
    for (const vec4& result : test.results<vec4>()) {
        ++counts[static_cast<std::size_t>(result.z)];
    }
    expectCounts("channels", counts, std::vector<double>{0.25 * kCount, 0.125 * kCount, 0.625 * kCount}, 1);
}

}  // namespace glim::scattering_test
