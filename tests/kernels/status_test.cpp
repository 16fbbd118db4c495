#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace glim::status_test {

struct Case {
    uint isBad = 0;
    uint loops = 1;
};

struct Outcome {
    Status status;
    std::vector<uint> loopsRun;
    std::uint32_t loopsSpent;
};

Outcome run(const std::vector<Case>& cases)
{
    Buffer status(testDevice(), "test's status", BufferKind::Storage, sizeof(Status));
    const Status empty{};
    upload(status, std::span<const Status>(&empty, 1));
    KernelTest test(test_kernels::status_test);
    test.cases(cases).resultsOf<uint>(cases.size()).buffers({{kBindStatus, &status}}).mayExhaustLoops().run();
    return {download<Status>(status, 1)[0], test.results<uint>(), test.loopsSpent()};
}

// Every sample that is not finite is counted; the first kMaxLocated to be counted are located, each once.
TEST(StatusTest, H37CountsAndLocatesNonFiniteSamples)
{
    for (const std::uint32_t bad : {0U, 1U, kMaxLocated, 300U}) {
        std::vector<Case> cases(1000);
        std::set<std::uint32_t> threads;
        for (std::uint32_t i = 0; i < bad; ++i) {
            threads.insert(7 + 3 * i);
            cases[7 + 3 * i].isBad = 1;
        }
        const Status status = run(cases).status;
        EXPECT_EQ(status.nonFinite, bad);
        EXPECT_EQ(status.loopCaps, 0U);
        std::set<std::uint32_t> found;
        for (std::uint32_t i = 0; i < std::min(bad, kMaxLocated); ++i) {
            EXPECT_EQ(threads.count(status.located[i].pixel), 1U);
            EXPECT_EQ(status.located[i].sampleIndex, 2 * status.located[i].pixel + 1);
            found.insert(status.located[i].pixel);
        }
        EXPECT_EQ(found.size(), std::min(bad, kMaxLocated));
    }
}

// H42: a loop that the driver cut short is flagged, one that it let run is not.
TEST(StatusTest, H42FlagsALoopThatTheDriverStopped)
{
    std::vector<Case> cases(64);
    cases[5].loops = 70'000;
    const Outcome outcome = run(cases);
    const bool stopped = outcome.loopsRun[5] < 70'000;
    printHardCase("H42", "a loop of 70,000 steps", 1, "ran " + std::to_string(outcome.loopsRun[5]) + ", reported if less");
    EXPECT_EQ(outcome.status.loopCaps > 0, stopped);
    EXPECT_EQ(outcome.loopsSpent > 0, stopped);
    EXPECT_TRUE(stopped || outcome.loopsRun[5] == 70'000);
}

}  // namespace glim::status_test
