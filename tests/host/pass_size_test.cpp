#include "host/render/pass_size.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

constexpr std::uint32_t kCapacity = 1U << 23U;

// The sizes of passes on a device whose longest dispatch takes so long for each path, once the first passes are done.
std::vector<std::uint32_t> steadySizes(double secondsPerPath)
{
    PassSize size(FlatScene(), RenderSettings(), kCapacity);
    std::vector<std::uint32_t> sizes;
    for (int i = 0; i < 60; ++i) {
        const std::uint32_t paths = size.paths();
        size.learn(paths, {paths * secondsPerPath, 4.0 * paths * secondsPerPath});
        if (i >= 30) {
            sizes.push_back(size.paths());
        }
    }
    return sizes;
}

TEST(PassSizeTest, AFastDeviceTracesAsManyPathsAsItHasRoomFor)
{
    for (const std::uint32_t paths : steadySizes(1e-10)) {
        EXPECT_EQ(paths, kCapacity);
    }
}

// It does not shrink and grow again: each size is near the one before.
TEST(PassSizeTest, ALessFastOneTracesWhatItsLongestDispatchDoesInFiveMilliseconds)
{
    for (const std::uint32_t paths : steadySizes(2e-9)) {
        EXPECT_NEAR(paths, 2.5e6, 2.0);
    }
}

TEST(PassSizeTest, ASlowOneTracesNoMoreThanIsSafeWhereTheNextPassCostsMuchMore)
{
    for (const std::uint32_t paths : steadySizes(1e-7)) {
        EXPECT_EQ(paths, 1U << 17U);
    }
}

TEST(PassSizeTest, NoDispatchIsToTakeLongerThanItsTarget)
{
    for (const std::uint32_t paths : steadySizes(1e-5)) {
        EXPECT_NEAR(paths, 5000.0, 2.0);
    }
}

}  // namespace
}  // namespace glim
