#include "harness/kernel_run.hpp"
#include "harness/statistics.hpp"
#include "test_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

TEST(RandomNumberTest, IsUniform)
{
    constexpr std::size_t kNumbers = 1 << 18, kCells = 256;
    glim::KernelRun test(glim::test_kernels::random_number_test, KERNEL_FOLDER);
    test.resultsOf<float>(kNumbers).threads(kNumbers).seed(7).run();

    std::vector<double> counts(kCells), numbers;
    for (const float x : test.results<float>()) {
        ++counts[std::min(static_cast<std::size_t>(x * kCells), kCells - 1)];
        numbers.push_back(x);
    }
    const std::vector<double> expected(kCells, static_cast<double>(kNumbers) / kCells);
    constexpr std::size_t kComparisons = 2;
    glim::expectCounts("cells", counts, expected, kComparisons);
    glim::expectSampleMean("mean", numbers, 0.5, kComparisons);
}
