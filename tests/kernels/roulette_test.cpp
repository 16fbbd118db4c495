#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::roulette_test {

struct Case {
    vec3 throughput;
    float etaScale;
    uint bounce;
    float survival;
    float q = 0.7F, survivalOfQ = 1.0F;
};

// H24: min(1, 3 times the largest throughput freed of eta^2), from the third hit on; in particular 1, not .95, at albedo .99.
TEST(RouletteTest, H24SurvivalProbabilityFollowsTheThroughput)
{
    std::vector<Case> cases;
    for (const float t : {1e-6F, 0.01F, 0.3F, 0.5F, 0.7F, 0.95F, 0.99F, 1.0F, 2.25F}) {
        for (const float eta : {1.0F, 2.25F, 1.0F / 2.25F}) {
            for (const uint bounce : {0U, 1U, 2U, 3U, 100U}) {
                const float expected = bounce < 2 ? 1.0F : std::min(1.0F, 3.0F * t * eta);
                cases.push_back({{t, 0.5F * t, 0.1F * t}, eta, bounce, expected});
                cases.push_back({{0.2F * t, 0.5F * t, t}, eta, bounce, expected});
            }
        }
    }
    for (Case& c : cases) {
        c.survivalOfQ = c.bounce == 0 ? 1.0F : c.q;
    }
    KernelTest(test_kernels::roulette_test).cases(cases).run();
}

// The first indirect bounce is certain, each later one has the probability q, whatever the throughput.
TEST(RouletteTest, FixedRuleSparesTheFirstBounce)
{
    std::vector<Case> cases;
    for (const float q : {0.0F, 0.3F, 0.7F, 1.0F}) {
        for (const float t : {0.01F, 1.0F}) {
            cases.push_back({vec3(t), 1.0F, 0, 1.0F, q, 1.0F});
            cases.push_back({vec3(t), 1.0F, 1, 1.0F, q, q});
            cases.push_back({vec3(t), 1.0F, 2, std::min(1.0F, 3.0F * t), q, q});
            cases.push_back({vec3(t), 1.0F, 64, std::min(1.0F, 3.0F * t), q, q});
        }
    }
    KernelTest(test_kernels::roulette_test).cases(cases).run();
}

}  // namespace glim::roulette_test
