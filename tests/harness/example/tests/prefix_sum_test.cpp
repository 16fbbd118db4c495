#include "harness/kernel_run.hpp"
#include "harness/random.hpp"
#include "test_kernels.hpp"

#include <gtest/gtest.h>

#include <vector>

TEST(PrefixSumTest, EachWorkgroupHasItsOwn)
{
    glim::Random random(1);
    std::vector<std::uint32_t> values, expected;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        values.push_back(random.below(1000));
        const std::uint32_t before = i % glim::kTestWorkgroup == 0 ? 0 : expected.back();
        expected.push_back(before + values.back());
    }
    glim::KernelRun test(glim::test_kernels::prefix_sum_test, KERNEL_FOLDER);
    test.cases(values).resultsOf<std::uint32_t>(values.size()).run();
    EXPECT_EQ(test.results<std::uint32_t>(), expected);
}
