#include "tests/harness/statistics.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

// Tables of the chi-square distribution: Abramowitz and Stegun, table 26.8.
TEST(StatisticsTest, ChiSquareTailMatchesTables)
{
    EXPECT_NEAR(chiSquareTail(3.84146, 1.0), 0.05, 1e-6);
    EXPECT_NEAR(chiSquareTail(18.3070, 10.0), 0.05, 1e-6);
    EXPECT_NEAR(chiSquareTail(2.55821, 10.0), 0.99, 1e-6);
    EXPECT_NEAR(chiSquareTail(149.449, 100.0), 0.001, 1e-6);
}

TEST(StatisticsTest, ScoreLimitOf200Comparisons) { EXPECT_NEAR(scoreLimit(200), 4.56, 0.01); }

}  // namespace
}  // namespace glim
