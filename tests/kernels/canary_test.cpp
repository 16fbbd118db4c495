#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::canary_test {

std::vector<uvec2> countTo(std::uint32_t steps)
{
    KernelTest test(test_kernels::canary_test);
    test.cases(std::vector<uint>(64, steps)).resultsOf<uvec2>(64);
    test.run();
    return test.results<uvec2>();
}

// H42: either the loop ran to its end or the canary says that it did not. Some stop at 65,535 iterations.
TEST(CanaryTest, H42ReportsALoopThatTheDriverCutShort)
{
    for (const uvec2& lane : countTo(70000)) {
        EXPECT_TRUE(lane.x == 70000 || lane.y == 1) << lane.x << " iterations, unreported";
    }
}

TEST(CanaryTest, IsSilentWithinTheBudget)
{
    for (const uvec2& lane : countTo(60000)) {
        EXPECT_EQ(lane.x, 60000U);
        EXPECT_EQ(lane.y, 0U);
    }
}

}  // namespace glim::canary_test
