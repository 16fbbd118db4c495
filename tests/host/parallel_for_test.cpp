#include "host/bvh/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace glim {
namespace {

TEST(ParallelFor, DoesEveryPieceOfWorkOnce)
{
    for (const unsigned threads : {0U, 1U, 2U, 7U}) {
        for (const std::size_t count : {0, 1, 2, 1000}) {
            std::vector<int> done(count, 0);  // no two pieces share an element: what the thread sanitizer watches
            parallelFor(count, threads, [&](std::size_t i) { ++done[i]; });
            EXPECT_EQ(done, std::vector<int>(count, 1)) << threads << " threads";
        }
    }
}

TEST(ParallelFor, PassesOnWhatTheWorkThrows)
{
    for (const unsigned threads : {1U, 4U}) {
        std::atomic<int> begun = 0;
        const auto work = [&](std::size_t i) {
            ++begun;
            if (i == 3) {
                throw std::runtime_error("piece 3");
            }
        };
        EXPECT_THROW(parallelFor(100, threads, work), std::runtime_error);
        EXPECT_GE(begun, 1);
    }
}

}  // namespace
}  // namespace glim
