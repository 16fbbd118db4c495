#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::pass_test {

struct Case {
    uint seed, pixel, index;
};

struct Result {
    uint visits;
    uint group;
};

constexpr std::uint32_t kGroupSize = 64;

// Slots as path_types.h lays them out: pixel after pixel, the samples of each together.
// `chosen`: the pixels of an adaptive pass; empty: all.
std::vector<Case> samplesInOrder(KernelTest& test, std::uint32_t count, const std::vector<ChosenPixel>& chosen = {})
{
    const Pass& pass = test.pass();
    std::vector<Case> cases;
    for (std::uint32_t pixel = 0; cases.size() < count; ++pixel) {
        for (std::uint32_t sample = 0; sample < pass.sampleCount && cases.size() < count; ++sample) {
            const std::uint32_t number = pass.firstPixel + pixel;
            const ChosenPixel at = chosen.empty() ? ChosenPixel{number, 0} : chosen[number];
            cases.push_back({test.parameters().seed, pass.tileBegin + at.pixel, pass.firstSample + at.samplesBefore + sample});
        }
    }
    return cases;
}

TEST(PassTest, VisitsEveryPlaceOnceFromBothHalvesAndKnowsItsSample)
{
    for (const std::uint32_t groups : {1U, 2U, 3U, 4U, 7U, 64U, 101U}) {
        SCOPED_TRACE(std::to_string(groups) + " groups");
        KernelTest test(test_kernels::pass_test);
        Pass& pass = test.pass();
        test.parameters().seed = 0xdeadbeefU + groups;
        pass.tileBegin = 1U << 20;
        pass.firstPixel = 500;
        pass.firstSample = 96;
        pass.sampleCount = 1 + groups % 32;
        const std::uint32_t threads = groups * kGroupSize;
        test.cases(samplesInOrder(test, threads)).resultsOf<Result>(threads).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::uint32_t place = 0; place < threads; ++place) {
            EXPECT_EQ(results[place].visits, 1U) << "place " << place;
            // Neighbouring groups of slots run in different halves of the dispatch.
            const bool second = results[place].group >= (groups + 1) / 2;
            EXPECT_EQ(second, place / kGroupSize % 2 == 1) << "place " << place;
        }
    }
}

TEST(PassTest, GoesOverChosenPixelsIfAdaptive)
{
    constexpr std::uint32_t kThreads = 10 * kGroupSize;
    KernelTest test(test_kernels::pass_test);
    Pass& pass = test.pass();
    pass.tileBegin = 7000;
    pass.firstPixel = 500;
    pass.firstSample = 5;
    pass.sampleCount = 3;
    Random random(50);
    std::vector<ChosenPixel> chosen(pass.firstPixel + kThreads);
    std::vector<uint> counted{static_cast<uint>(chosen.size())};
    for (ChosenPixel& each : chosen) {
        each = {random.below(1U << 20), random.below(1000)};
        counted.insert(counted.end(), {each.pixel, each.samplesBefore});
    }
    Buffer list(testDevice(), "test's choice", BufferKind::Storage, counted.size() * sizeof(uint));
    upload(list, std::span<const uint>(counted));
    test.cases(samplesInOrder(test, kThreads, chosen)).resultsOf<Result>(kThreads);
    test.buffers({{kBindChosenPixels, &list}}).specialize(kSpecChosen, 1).run();
}

}  // namespace glim::pass_test
