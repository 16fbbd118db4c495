#include "host/flatten/alias_table.hpp"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kDraws = 8;
constexpr double kTwo64 = 0x1p64;

struct Case {
    AliasEntry entry;
    std::uint32_t first, last;
};

// The first of the 2^32 numbers whose product with `count` has `bin` as upper word.
std::uint64_t firstOf(std::uint64_t bin, std::uint64_t count)
{
    return ((bin << 32) + count - 1) / count;
}

// With which each entry is drawn, as a count of the 2^64 pairs of numbers, exact but for the last rounding. That the device
// draws with these bins and thresholds the kernel proves at their limits.
std::vector<double> enumerate(const std::vector<Case>& cases)
{
    std::vector<unsigned __int128> pairs(cases.size(), 0);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const unsigned __int128 bin = static_cast<std::uint64_t>(cases[i].last) - cases[i].first + 1;
        pairs[i] += bin * cases[i].entry.threshold;
        pairs[cases[i].entry.other] += bin * (0x100000000U - static_cast<std::uint64_t>(cases[i].entry.threshold));
    }
    std::vector<double> probabilities(cases.size());
    std::transform(pairs.begin(), pairs.end(), probabilities.begin(),
                   [](unsigned __int128 count) { return static_cast<double>(count) / kTwo64; });
    return probabilities;
}

std::vector<Case> casesOf(const AliasTable& table)
{
    std::vector<Case> cases;
    const std::uint64_t count = table.entries.size();
    for (std::uint64_t i = 0; i < count; ++i) {
        cases.push_back({table.entries[i], static_cast<std::uint32_t>(firstOf(i, count)),
                         static_cast<std::uint32_t>(firstOf(i + 1, count) - 1)});
    }
    return cases;
}

// The table against its weights: probabilities as implemented are those it names, and near the wanted ones.
void expectTable(const std::string& what, const std::vector<double>& weights, double relative)
{
    const AliasTable table = buildAliasTable(weights);
    const std::vector<Case> cases = casesOf(table);
    const std::vector<double> exact = enumerate(cases);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double rounding = 0x1p-53 * (static_cast<double>(weights.size()) + 4.0);  // of a sum over all bins in double
    double worst = 0.0, total = 0.0;
    std::size_t never = 0, misnamed = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        total += table.probabilities[i];
        never += table.probabilities[i] > 0.0 ? 0 : 1;
        misnamed += std::abs(table.probabilities[i] - exact[i]) <= rounding * exact[i] ? 0 : 1;
        // A weight of less than 2^-32 of a bin is drawn more often than it wants, by design.
        const double wanted = weights[i] / sum, grain = 0x1p-32 / static_cast<double>(weights.size());
        worst = std::max(worst, std::max(0.0, std::abs(exact[i] - wanted) - grain) / wanted);
    }
    std::cout << "  " << what << ": sum - 1 = " << total - 1.0 << ", largest relative error " << worst << '\n';
    EXPECT_EQ(never, 0U) << what;
    EXPECT_EQ(misnamed, 0U) << what;
    EXPECT_NEAR(total, 1.0, 1e-6) << what;
    EXPECT_LE(worst, relative) << what;
    std::vector<double> counts(weights.size(), 0.0), expected(weights.size());
    for (int round = 0; round < testRounds(); ++round) {
        KernelTest test(test_kernels::alias_test);
        test.pass().seed = static_cast<std::uint32_t>(round) + 50;
        test.cases(cases).resultsOf<std::uint32_t>(cases.size() * kDraws).run();
        for (const std::uint32_t drawn : test.results<std::uint32_t>()) {
            ++counts[drawn];
        }
    }
    const double draws = static_cast<double>(cases.size()) * kDraws * testRounds();
    std::transform(exact.begin(), exact.end(), expected.begin(), [draws](double p) { return p * draws; });
    expectCounts(what, counts, expected, 4);
}

// H14: a million lights of lognormal power; one bright light before many dim ones; few lights; equal ones.
TEST(AliasTest, DrawsAMillionLights)
{
    Random random(51);
    std::vector<double> weights(1000000);
    std::generate(weights.begin(), weights.end(), [&random] { return std::exp(2.0 * random.normal()); });
    expectTable("1e6 lognormal", weights, 1e-3);
}

TEST(AliasTest, DrawsDimLightsBesideABrightOne)
{
    std::vector<double> weights(200001, 1e-8);
    weights[0] = 1.0;
    expectTable("one bright, 2e5 dim", weights, 1e-3);
}

TEST(AliasTest, DrawsFewLights)
{
    std::vector<double> weights(3000);
    Random random(52);
    std::generate(weights.begin(), weights.end(), [&random] { return random.logUniform(1e-3, 1.0); });
    expectTable("3000", weights, 1e-6);
}

TEST(AliasTest, DrawsEqualLights)
{
    expectTable("1000 equal", std::vector<double>(1000, 3.0), 1e-6);
}

// Weights whose ratio exceeds 2^32 keep a positive probability, and the largest double does not overflow.
TEST(AliasTest, KeepsTheDimmest)
{
    const AliasTable table = buildAliasTable(std::vector<double>{1e300, 1.0, 1e308, 1e-300});
    const std::vector<double> exact = enumerate(casesOf(table));
    for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_GT(exact[i], 0.0);
        EXPECT_NEAR(table.probabilities[i], exact[i], 1e-15);
    }
    EXPECT_EQ(buildAliasTable(std::vector<double>{5.0}).probabilities, std::vector<double>{1.0});
}

}  // namespace
}  // namespace glim
