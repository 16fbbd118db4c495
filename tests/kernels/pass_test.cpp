#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim {
namespace {

// For odd and even numbers of workgroups.
TEST(PassTest, InterleavingReachesEverySlotOnce)
{
    for (const std::uint32_t slots : {1U, 64U, 65U, 129U, 640U, 1000U}) {
        KernelTest test(test_kernels::pass_test);
        test.resultsOf<uint>(slots).threads(slots);
        test.pass().sampleCount = 1;
        test.pass().seed = 7;
        test.pass().slabBegin = 1000;
        test.pass().firstPixel = 100;
        test.pass().firstSample = 64;
        test.run();
        const std::vector<uint> visits = test.results<uint>();
        EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](uint n) { return n == 1; })) << slots << " slots";
    }
}

TEST(PassTest, SeveralSamplesOfAPixelAreNeighbours)
{
    KernelTest test(test_kernels::pass_test);
    test.threads(64).resultsOf<uint>(64);
    test.pass().pixelCount = 16;
    test.pass().sampleCount = 4;
    test.pass().firstSample = 8;
    test.run();
    EXPECT_EQ(std::ranges::count(test.results<uint>(), 1U), 64);
}

}  // namespace
}  // namespace glim
