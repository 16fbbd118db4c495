#include "host/job/progress.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

RenderProgress progressOf(std::uint64_t samples, std::uint64_t total, double seconds, std::uint64_t resumed = 0)
{
    return {samples, total, seconds, resumed};
}

TEST(ProgressEstimate, IsOfWhatIsLeft)
{
    const ProgressEstimate half = estimateProgress(progressOf(50, 100, 3.0), std::nullopt);
    EXPECT_DOUBLE_EQ(half.share, 0.5);
    EXPECT_DOUBLE_EQ(half.remaining.value(), 3.0);
    const ProgressEstimate resumed = estimateProgress(progressOf(60, 100, 1.0, 50), std::nullopt);
    EXPECT_DOUBLE_EQ(resumed.share, 0.6);
    EXPECT_NEAR(resumed.remaining.value(), 4.0, 1e-9);
    EXPECT_DOUBLE_EQ(estimateProgress(progressOf(100, 100, 3.0), std::nullopt).remaining.value(), 0.0);
    const ProgressEstimate timed = estimateProgress(progressOf(1, 1000, 2.0), 8.0);
    EXPECT_DOUBLE_EQ(timed.share, 0.25);
    EXPECT_DOUBLE_EQ(timed.remaining.value(), 6.0);
}

// Whatever a plan says, and however wrong it was.
TEST(ProgressEstimate, IsAShareAndATimeOrUnknown)
{
    constexpr std::uint64_t kMax = ~std::uint64_t{0};
    for (const std::uint64_t samples :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{99}, std::uint64_t{104}, std::uint64_t{1} << 60U, kMax}) {
        for (const std::uint64_t total : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{100}, kMax}) {
            for (const std::uint64_t resumed : {std::uint64_t{0}, samples / 2, samples}) {
                for (const double seconds : {0.0, 1e-9, 1.0, 1e9}) {
                    for (const auto limit : {std::optional<double>(), std::optional(0.0), std::optional(1e-3), std::optional(1e3)}) {
                        const ProgressEstimate estimate = estimateProgress(progressOf(samples, total, seconds, resumed), limit);
                        EXPECT_TRUE(estimate.share >= 0.0 && estimate.share <= 1.0) << estimate.share;
                        EXPECT_TRUE(!estimate.remaining || *estimate.remaining >= 0.0) << *estimate.remaining;
                    }
                }
            }
        }
    }
    EXPECT_FALSE(estimateProgress(progressOf(103, 100, 1.0), std::nullopt).remaining) << "past an end that was foretold";
    EXPECT_FALSE(estimateProgress(progressOf(0, 100, 1.0), std::nullopt).remaining) << "nothing is rendered";
    EXPECT_FALSE(estimateProgress(progressOf(50, 100, 1.0, 50), std::nullopt).remaining) << "nothing is rendered in this run";
}

TEST(ProgressBar, LeavesTheLastColumnFree)
{
    EXPECT_EQ(fitBar("[##..]", 80), "[##..]");
    EXPECT_EQ(fitBar("[##..]", 7), "[##..]");
    EXPECT_EQ(fitBar("[##..]", 6), "[##..");
    EXPECT_EQ(fitBar("[##..]", 1), "");
    EXPECT_EQ(fitBar("[##..]", 0), "[##..]") << "unknown";
}

}  // namespace
}  // namespace glim
