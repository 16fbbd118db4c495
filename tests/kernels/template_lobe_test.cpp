// The lobe's samples against its density and its value: chi-square, integrals over all directions, energy.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::template_lobe_test {

// As in the kernel.
constexpr std::size_t kBands = 32, kSectors = 32, kCells = kBands * kSectors;
constexpr uint kSamples = 1 << 16;
constexpr double kQuadrature = 1e-4;  // the error of the kernel's integrals

struct Case {
    vec3 wo;
    float exponent;
    float albedo;
};

struct Result {
    vec3 wi;
    float weight;
    float density, reflected;
};

// The cell of `share`, of [0, 1], among `count` equal ones.
std::size_t chooseCell(double share, std::size_t count)
{
    return std::min(static_cast<std::size_t>(std::max(share, 0.0) * static_cast<double>(count)), count - 1);
}

std::size_t cellOf(const vec3& wi)
{
    const glm::dvec3 w(wi);
    return chooseCell(0.5 * (1.0 - w.z), kBands) * kSectors + chooseCell(0.5 + 0.5 * std::atan2(w.y, w.x) / std::numbers::pi, kSectors);
}

void check(const std::string& what, const Case& c, std::span<const Result> results, std::size_t tests)
{
    std::vector<double> counts(kCells), expected(kCells), weights;
    double density = 0.0, reflected = 0.0;
    for (std::size_t i = 0; i < kCells; ++i) {
        expected[i] = static_cast<double>(results[i].density) * kSamples;
        density += static_cast<double>(results[i].density);
        reflected += static_cast<double>(results[i].reflected);
    }
    for (const Result& result : results) {
        ++counts[cellOf(result.wi)];
        weights.push_back(static_cast<double>(result.weight));
    }
    EXPECT_NEAR(density, 1.0, kQuadrature) << what << ": the density's integral";
    EXPECT_LE(reflected, static_cast<double>(c.albedo) + kQuadrature) << what << ": energy";
    expectCounts(what, counts, expected, tests);
    expectSampleMean(what + ", energy", weights, reflected, tests);
}

TEST(TemplateLobeTest, SamplesHaveItsDensityAndEnergy)
{
    std::vector<Case> cases;
    for (const float exponent : {1.0F, 5.0F, 40.0F}) {
        for (const double cosine : {1.0, 0.6, 0.05}) {
            const double sine = std::sqrt(1.0 - cosine * cosine);
            cases.push_back({glm::dvec3(sine * std::cos(0.7), sine * std::sin(0.7), cosine), exponent, 0.8F});
        }
    }
    for (int round = 0; round < testRounds(); ++round) {
        const std::size_t threads = cases.size() * kSamples;
        KernelTest test(test_kernels::template_lobe_test);
        test.parameters().seed = static_cast<std::uint32_t>(round) + 1;
        test.pass().sampleCount = kSamples;
        test.cases(cases).resultsOf<Result>(threads).threads(static_cast<std::uint32_t>(threads)).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const std::string what = "exponent " + std::to_string(cases[i].exponent) + ", cosine " + std::to_string(cases[i].wo.z);
            check(what, cases[i], std::span(results).subspan(i * kSamples, kSamples),
                  2 * cases.size() * static_cast<std::size_t>(testRounds()));
        }
    }
}

}  // namespace glim::template_lobe_test
