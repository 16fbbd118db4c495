#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim {
namespace {

struct Result {
    std::uint32_t steps, hash, spent;
};

std::uint32_t hashOf(std::uint32_t steps)
{
    std::uint32_t hash = 1;
    for (std::uint32_t i = 0; i < steps; ++i) {
        hash = (hash ^ i) * 16777619U;
    }
    return hash;
}

Result runLoop(std::uint32_t steps)
{
    KernelTest test(test_kernels::canary_test);
    test.cases(std::vector<std::uint32_t>(64, steps)).resultsOf<Result>(64).run();
    const std::vector<Result> results = test.results<Result>();
    for (const Result& result : results) {
        EXPECT_EQ(result.spent, results[0].spent);
        EXPECT_EQ(result.steps, results[0].steps);
    }
    return results[0];
}

TEST(CanaryTest, IsSilentAfterAFewSteps)
{
    for (const std::uint32_t steps : {0U, 1U, 1000U, 60000U}) {
        const Result result = runLoop(steps);
        EXPECT_EQ(result.steps, steps);
        EXPECT_EQ(result.hash, hashOf(steps));
        EXPECT_EQ(result.spent, 0U) << steps << " steps";
    }
}

// H42: either the driver ran the whole loop, or the canary tells that it did not.
TEST(CanaryTest, TellsOfALoopCutShort)
{
    for (const std::uint32_t steps : {70000U, 200000U}) {
        const Result result = runLoop(steps);
        std::cout << "  " << result.steps << " of " << steps << " steps ran; the canary is "
                  << (result.spent != 0 ? "set" : "silent") << '\n';
        const bool whole = result.steps == steps && result.hash == hashOf(steps);
        EXPECT_EQ(result.spent, whole ? 0U : 1U);
    }
}

}  // namespace
}  // namespace glim
