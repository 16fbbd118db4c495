#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace glim {
namespace {

struct Case {
    vec3 contribution;
    uint events;
    PathRadiance expected;
};

// Light that met two surfaces or more keeps its colour and has no channel above the limit; what is lost is told by its mean.
PathRadiance add(const PathRadiance& sum, const glm::dvec3& light, uint events, double limit)
{
    const double largest = std::max({light.r, light.g, light.b});
    const double scale = events >= 2 && largest > limit ? limit / largest : 1.0;
    const glm::dvec3 lost = (1.0 - scale) * light;
    return {glm::vec3(glm::dvec3(sum.radiance) + scale * light),
            static_cast<float>(static_cast<double>(sum.clamped) + (lost.r + lost.g + lost.b) / 3.0)};
}

TEST(RadianceTest, AddsLightAndTellsWhatTheClampTook)
{
    for (const float limit : {std::numeric_limits<float>::infinity(), 3.0F, 0.1F}) {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> light(0.0F, 10.0F);
        std::vector<Case> cases;
        std::vector<PathRadiance> before;
        for (uint i = 0; i < 1000; ++i) {
            before.push_back({vec3(light(random), light(random), 0.5F), 0.1F * light(random)});
            const vec3 contribution(light(random), i % 7 == 0 ? 0.0F : light(random), 0.1F * light(random));
            const uint events = i % 4;
            cases.push_back({contribution, events,
                             add(before.back(), glm::dvec3(contribution), events, static_cast<double>(limit))});
        }
        Buffer sums(testDevice(), "test's radiance", BufferKind::Storage, before.size() * sizeof(PathRadiance));
        upload(sums, std::span<const PathRadiance>(before));
        KernelTest test(test_kernels::radiance_test);
        test.pass().clampIndirect = limit;
        test.cases(cases).buffers({{kBindRadiance, &sums}}).run();
    }
}

}  // namespace
}  // namespace glim
