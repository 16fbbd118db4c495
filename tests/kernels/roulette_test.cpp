#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim {
namespace {

struct Case {
    vec3 throughput;
    float etaScale;
    uint bounce;
    float survival;
};

// H24: min(1, largest throughput freed of eta^2), from the fourth hit on; in particular 1, not .95, at albedo .99.
TEST(RouletteTest, H24SurvivesByThroughput)
{
    std::vector<Case> cases;
    for (const float t : {1e-6F, 0.01F, 0.5F, 0.7F, 0.95F, 0.99F, 1.0F, 2.25F}) {
        for (const float eta : {1.0F, 2.25F, 1.0F / 2.25F}) {
            for (const uint bounce : {0U, 2U, 3U, 4U, 100U}) {
                const float expected = bounce < 3 ? 1.0F : std::min(1.0F, t * eta);
                cases.push_back({{t, 0.5F * t, 0.1F * t}, eta, bounce, expected});
                cases.push_back({{0.2F * t, 0.5F * t, t}, eta, bounce, expected});
            }
        }
    }
    KernelTest(test_kernels::roulette_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
