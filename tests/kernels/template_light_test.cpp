// The light's samples against its density: chi-square, the integral over all directions, and the irradiance that they estimate.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::template_light_test {

// As in the kernel.
constexpr std::size_t kRings = 32, kSectors = 64, kCells = kRings * kSectors;
constexpr uint kSamples = 1 << 16;

struct Case {
    vec3 p, center, normal;
    float radius;
};

struct Result {
    vec3 point;
    float received, density;
};

// The cell of `share`, of [0, 1], among `count` equal ones.
std::size_t chooseCell(double share, std::size_t count)
{
    return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count)), count - 1);
}

std::size_t cellOf(const vec3& point)
{
    const glm::dvec3 p(point);
    return chooseCell(p.x * p.x + p.y * p.y, kRings) * kSectors + chooseCell(0.5 + 0.5 * std::atan2(p.y, p.x) / std::numbers::pi, kSectors);
}

// Returns what each sample receives.
std::vector<double> check(const std::string& what, std::span<const Result> results, std::size_t tests)
{
    std::vector<double> counts(kCells), expected(kCells), received;
    double density = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
        expected[i] = static_cast<double>(results[i].density) * kSamples;
        density += static_cast<double>(results[i].density);
    }
    for (const Result& result : results) {
        ++counts[cellOf(result.point)];
        received.push_back(static_cast<double>(result.received));
    }
    EXPECT_NEAR(density, 1.0, 1e-5) << what << ": the density's integral";
    expectCounts(what, counts, expected, tests);
    return received;
}

TEST(TemplateLightTest, SamplesHaveItsDensityAndLight)
{
    std::vector<Case> cases;
    for (const float height : {0.1F, 1.0F, 10.0F}) {
        cases.push_back({{0, 0, 0}, {0, 0, height}, {0, 0, -1}, 0.5F});  // right above
        cases.push_back({{0, 0, 0}, {1, 0.3, height}, glm::normalize(glm::dvec3(-0.5, 0.2, -1.0)), 0.5F});
    }
    for (int round = 0; round < testRounds(); ++round) {
        const std::size_t threads = cases.size() * kSamples;
        KernelTest test(test_kernels::template_light_test);
        test.parameters().seed = static_cast<std::uint32_t>(round) + 1;
        test.pass().sampleCount = kSamples;
        test.cases(cases).resultsOf<Result>(threads).threads(static_cast<std::uint32_t>(threads)).run();
        const std::vector<Result> results = test.results<Result>();
        const std::size_t tests = cases.size() * 3 / 2 * static_cast<std::size_t>(testRounds());
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const std::string what = "light at " + std::to_string(cases[i].center.z) + (i % 2 == 0 ? ", above" : ", aside");
            const std::vector<double> received = check(what, std::span(results).subspan(i * kSamples, kSamples), tests);
            if (i % 2 == 0) {
                // What a parallel disk right above sends: pi r^2 / (r^2 + h^2).
                const double radius2 = 0.25, height = static_cast<double>(cases[i].center.z);
                expectSampleMean(what + ", irradiance", received, std::numbers::pi * radius2 / (radius2 + height * height), tests);
            }
        }
    }
}

}  // namespace glim::template_light_test
