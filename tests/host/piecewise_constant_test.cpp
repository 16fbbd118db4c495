#include "host/flatten/piecewise_constant.hpp"

#include "tests/harness/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

// Every random word falls to one entry, which the search between searchBegin and searchEnd of its bin finds.
void expectPartition(const std::vector<PiecewiseConstantEntry>& entries)
{
    const std::uint64_t count = entries.size();
    EXPECT_EQ(entries.front().first, 0U);
    EXPECT_EQ(entries.back().last, 0xffffffffU);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_LE(entries[i].first, entries[i].last);
        EXPECT_TRUE(i == 0 || entries[i].first == entries[i - 1].last + 1);
        sum += computeProbability(entries[i]);
        for (const std::uint32_t word : {entries[i].first, entries[i].last}) {
            const PiecewiseConstantEntry& bin = entries[static_cast<std::size_t>(word * count >> 32)];
            EXPECT_LE(bin.searchBegin, i);
            EXPECT_GE(bin.searchEnd, i);
        }
    }
    EXPECT_DOUBLE_EQ(sum, 1.0);
}

TEST(PiecewiseConstant, ProbabilitiesAreInProportionToWeights)
{
    Random random(1);
    for (const std::size_t count : {1U, 2U, 7U, 1000U, 65536U}) {
        std::vector<double> weights(count);
        double sum = 0.0;
        for (double& weight : weights) {
            weight = std::exp(3.0 * random.normal());
            sum += weight;
        }
        const std::vector<PiecewiseConstantEntry> entries = buildPiecewiseConstant(weights);
        expectPartition(entries);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(computeProbability(entries[i]), weights[i] / sum, 1e-9 * weights[i] / sum + 0x1p-31);
        }
    }
}

TEST(PiecewiseConstant, NoEntryIsLost)
{
    std::vector<double> weights(4096, 0.0);
    for (const std::size_t sun : {0U, 2000U, 4095U}) {
        weights.assign(weights.size(), 0.0);
        weights[sun] = 1e30;
        const std::vector<PiecewiseConstantEntry> entries = buildPiecewiseConstant(weights);
        expectPartition(entries);
        EXPECT_GT(computeProbability(entries[sun]), 1.0 - 1e-5);
    }
}

}  // namespace
}  // namespace glim
