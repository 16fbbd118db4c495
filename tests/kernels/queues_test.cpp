#include "host/render/path_buffers.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace glim::queues_test {

constexpr std::uint32_t kGroupSize = 64;  // kernel_test.cpp's
constexpr std::uint32_t kCapacity = 8192;

struct Outcome {
    std::vector<Round> rounds;
    std::vector<uint> next, shadow;
    RayCounts counts;
    std::uint32_t overflows;
};

// Round `round` of a pass of `threads` slots. Each of them queues a path for the next round.
Outcome run(std::uint32_t threads, std::uint32_t share, std::uint32_t round, const std::vector<Round>& before, const RayCounts& counts = {})
{
    PathBuffers paths(testDevice(), kCapacity);
    Buffer countsBuffer(testDevice(), "test's counts", BufferKind::Storage, sizeof(RayCounts));
    upload(countsBuffer, std::span<const RayCounts>(&counts, 1));
    Buffer status(testDevice(), "test's status", BufferKind::Storage, sizeof(Status));
    upload(status, std::span<const Status>(std::vector<Status>(1)));
    paths.setRounds(before);
    KernelTest test(test_kernels::queues_test);
    test.cases(std::vector<uint>(threads, share));
    test.pass().sampleCount = 1;
    test.pass().round = round;
    test.features(kAllFeatures & ~kFeatureCatcher);  // a path for each sample
    BufferMap bound = paths.buffers(0);
    bound[kBindRayCounts] = &countsBuffer;
    bound[kBindStatus] = &status;
    test.buffers(bound).run();
    return {paths.readRounds(), download<uint>(paths.nextQueue(0), kCapacity), download<uint>(paths.shadowQueue(), kCapacity),
            download<RayCounts>(countsBuffer, 1)[0], download<Status>(status, 1)[0].overflows};
}

std::vector<uint> sorted(std::vector<uint> entries, std::uint32_t count)
{
    entries.resize(count);
    std::sort(entries.begin(), entries.end());
    return entries;
}

TEST(QueuesTest, EveryEntryIsThereOnce)
{
    for (const std::uint32_t threads : {1U, kGroupSize + 1, 5000U}) {
        const Outcome outcome = run(threads, 1, 4, makeRounds(0, 0));
        const std::uint32_t shadowRays = (threads + 2) / 3;
        EXPECT_EQ(outcome.rounds[5].paths.count, threads);
        EXPECT_EQ(outcome.rounds[4].shadowRays.count, shadowRays);
        std::vector<uint> all(threads);
        std::iota(all.begin(), all.end(), 1000U);
        EXPECT_EQ(sorted(outcome.next, threads), all);
        std::vector<uint> thirds(shadowRays);
        std::generate(thirds.begin(), thirds.end(), [slot = 0U]() mutable { return std::exchange(slot, slot + 3); });
        EXPECT_EQ(sorted(outcome.shadow, shadowRays), thirds);
    }
}

std::uint32_t needed(std::uint32_t entries, std::uint32_t share) { return (entries + share * kGroupSize - 1) / (share * kGroupSize); }

// At least as many as their entries need, and fewer than kGroupsAtOnce more.
TEST(QueuesTest, CountWorkgroupsAsTheyGrow)
{
    constexpr std::uint32_t kEntries = kGroupsAtOnce * kGroupSize;
    for (const std::uint32_t share : {1U, 3U}) {
        for (const std::uint32_t threads : {1U, kGroupSize, kEntries - 1, kEntries, kEntries + 1, 3 * kEntries, 3 * kEntries + 1, 5000U}) {
            SCOPED_TRACE(std::to_string(threads) + " threads, share " + std::to_string(share));
            const Outcome outcome = run(threads, share, 4, makeRounds(0, 0));
            const auto expect = [](const Queue& queue, std::uint32_t groups) {
                EXPECT_EQ(queue.groups, uvec3((groups + kGroupsAtOnce - 1) / kGroupsAtOnce * kGroupsAtOnce, 1, 1));
            };
            expect(outcome.rounds[5].paths, needed(threads, share));
            expect(outcome.rounds[4].shadowRays, needed((threads + 2) / 3, 1));
        }
    }
}

TEST(QueuesTest, GoOnWhereTheyWere)
{
    std::vector<Round> before = makeRounds(0, 0);
    before[1].paths.count = 7;
    const Outcome outcome = run(2, 1, 0, before);
    EXPECT_EQ(outcome.rounds[1].paths.count, 9U);
    EXPECT_EQ(sorted({outcome.next[7], outcome.next[8]}, 2), (std::vector<uint>{1000, 1001}));
}

TEST(QueuesTest, OtherRoundsStayAsTheyWere)
{
    const Outcome outcome = run(100, 1, 4, makeRounds(7, 1));
    for (std::uint32_t round = 0; round <= kEmptyRound; ++round) {
        EXPECT_EQ(outcome.rounds[round].paths.count, round == 0 ? 7U : round == 5 ? 100U : 0U);
        EXPECT_EQ(outcome.rounds[round].shadowRays.count, round == 4 ? 34U : 0U);
        EXPECT_EQ(outcome.rounds[round].paths.groups, uvec3(round == 0 ? 1 : round == 5 ? kGroupsAtOnce : 0, 1, 1));
        EXPECT_EQ(outcome.rounds[round].shadowRays.groups, uvec3(round == 4 ? kGroupsAtOnce : 0, 1, 1));
    }
}

// Into the upper word; what is beyond one entry a slot is reported, and counted as no ray.
TEST(QueuesTest, RaysAreCountedAndOverflowsReported)
{
    const Outcome usual = run(100, 1, 0, makeRounds(100, 2), {uvec2(0xffffffff, 7), uvec2(0xffffffff - 101, 0)});
    EXPECT_EQ(usual.counts.closest, uvec2(99, 8));
    EXPECT_EQ(usual.counts.shadow, uvec2(0xffffffff, 0));
    EXPECT_EQ(usual.overflows, 0U);
    const Outcome more = run(100, 1, 0, makeRounds(103, 2));
    EXPECT_EQ(more.counts.closest, uvec2(100, 0));
    EXPECT_EQ(more.overflows, 3U);
    std::vector<Round> shadow = makeRounds(0, 0);
    shadow[0].shadowRays.count = 5000;
    const std::uint32_t overflows = run(100, 1, 0, shadow).overflows;
    EXPECT_GE(overflows, 4900U);
    EXPECT_LE(overflows, 4934U) << "the threads of this dispatch may have queued theirs before";
}

}  // namespace glim::queues_test
