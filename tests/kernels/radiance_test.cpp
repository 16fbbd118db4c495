#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace glim::radiance_test {

constexpr uint kLightSamples = 8, kGroups = 3;

struct Case {
    vec3 contribution;
    uint pathLength;
    uint share;
    uint group;
};

// Light that met two surfaces or more keeps its colour and has no channel above the limit; the mean of what is lost is reported.
PathRadiance add(const PathRadiance& sum, const glm::dvec3& light, uint pathLength, double limit)
{
    const double largest = std::max({light.r, light.g, light.b});
    const double scale = pathLength >= 2 && largest > limit ? limit / largest : 1.0;
    const glm::dvec3 lost = (1.0 - scale) * light;
    return {glm::vec3(glm::dvec3(sum.radiance) + scale * light),
            static_cast<float>(static_cast<double>(sum.clamped) + (lost.r + lost.g + lost.b) / 3.0)};
}

// Light of paths of length 0 to 3, in a pass that keeps the lengths [least, most].
void expectSums(float limit, uint least, uint most)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> light(0.0F, 10.0F);
    std::vector<Case> cases;
    std::vector<PathRadiance> before, expected;
    for (uint i = 0; i < 1000; ++i) {
        before.push_back({vec3(light(random), light(random), 0.5F), 0.1F * light(random)});
        const vec3 contribution(light(random), i % 7 == 0 ? 0.0F : light(random), 0.1F * light(random));
        const uint pathLength = i % 4;
        const uint share = i % 3 == 0 ? 1 : 0;
        const bool wanted = pathLength >= least && pathLength <= most;
        cases.push_back({contribution, pathLength, share, i % kGroups});
        const double clampLimit = static_cast<double>(limit) / (share != 0 ? kLightSamples : 1);
        expected.push_back(wanted ? add(before.back(), glm::dvec3(contribution), pathLength, clampLimit) : before.back());
    }
    Buffer sums(testDevice(), "test's radiance", BufferKind::Both, before.size() * sizeof(PathRadiance));
    upload(sums, std::span<const PathRadiance>(before));
    KernelTest test(test_kernels::radiance_test);
    test.lightRound().lightSamples = kLightSamples;
    test.parameters().clampIndirect = limit;
    test.parameters().minPathLength = least;
    test.parameters().maxPathLength = most;
    test.parameters().lightGroups = kGroups;
    Buffer groups(testDevice(), "test's light groups", BufferKind::Storage, before.size() * (sizeof(uint) + kGroups * sizeof(vec3)));
    upload(groups, std::span<const float>(std::vector<float>(before.size() * (1 + 3 * kGroups), 0.5F)));
    test.pass().sampleCount = 1;
    test.cases(cases).buffers({{kBindRadiance, &sums}, {kBindGroupLight, &groups}}).run();
    const std::vector<float> byGroup = download<float>(groups, before.size() * (1 + 3 * kGroups));
    const std::vector<PathRadiance> after = download<PathRadiance>(sums, cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const float sum = glm::length(expected[i].radiance);
        EXPECT_LE(glm::distance(after[i].radiance, expected[i].radiance), 4e-7F * sum) << "case " << i;
        for (uint g = 0; g < kGroups; ++g) {
            const float* of = &byGroup[i * (1 + 3 * kGroups) + 1 + 3 * g];
            const bool gets = g == cases[i].group && cases[i].share == 0;
            const vec3 added = gets ? expected[i].radiance - before[i].radiance : vec3(0.0F);
            EXPECT_LE(glm::distance(vec3(of[0], of[1], of[2]), added + 0.5F), 2e-6F * (sum + 1.0F)) << "case " << i << ", group " << g;
        }
        // The difference of contribution and kept: as right as the larger of them.
        EXPECT_NEAR(after[i].clamped, expected[i].clamped, 4e-7F * (glm::length(cases[i].contribution) + expected[i].clamped));
    }
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(RadianceTest, AddsLightAndTellsWhatTheClampTook)
{
    for (const float limit : {kInfinity, 3.0F, 0.1F}) {
        expectSums(limit, 0, 64);
    }
}

// Light that the pass does not keep is not reported as clamped either.
TEST(RadianceTest, DropsLightThatThePassDoesNotWant)
{
    for (const auto& [least, most] : {std::pair{0U, 0U}, {1U, 1U}, {0U, 1U}, {2U, 64U}, {1U, 2U}, {3U, 3U}, {4U, 64U}}) {
        SCOPED_TRACE("pathLength " + std::to_string(least) + " to " + std::to_string(most));
        expectSums(kInfinity, least, most);
        expectSums(0.1F, least, most);
    }
}

}  // namespace glim::radiance_test
