#include "host/flatten/alias_table.hpp"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 1024;

struct Table {
    uint count;
    AliasEntry entries[16];
};

// H14: an even grid of both numbers draws each entry as often as the table says, up to the grid's edges.
TEST(AliasTest, H14DrawsWithTheProbabilitiesOfTheTable)
{
    const std::vector<double> weights = {1.0, 5.0, 0.5, 2.0, 100.0, 0.001, 3.0, 3.0, 7.0, 20.0, 0.3};
    const AliasTable table = buildAliasTable(weights);
    Table flat{static_cast<uint>(weights.size()), {}};
    std::copy(table.entries.begin(), table.entries.end(), flat.entries);
    KernelTest test(test_kernels::alias_test);
    test.cases(std::vector<Table>{flat}).threads(kSide * kSide).resultsOf<uint>(16);
    test.run();
    const std::vector<uint> drawn = test.results<uint>();
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(table.probabilities[i], weights[i] / sum, 1e-9) << i;
        // Each of at most 11 bins ends within one column, each threshold within one row.
        EXPECT_NEAR(drawn[i] / double(kSide * kSide), table.probabilities[i], 12.0 / kSide) << i;
    }
    EXPECT_EQ(std::accumulate(drawn.begin(), drawn.end(), 0U), kSide * kSide);
}

// Half the sum of |difference| between the steps of a cumulative sum in float and what they should be.
double naiveDistance(const std::vector<double>& weights, double sum)
{
    float before = 0.0F;
    std::vector<float> steps;
    for (const double weight : weights) {
        const float after = before + static_cast<float>(weight);
        steps.push_back(after - before);
        before = after;
    }
    double distance = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        distance += 0.5 * std::abs(static_cast<double>(steps[i] / before) - weights[i] / sum);
    }
    return distance;
}

// A million lognormal weights, and one bright light before a million dim ones: none is lost, and the probabilities that the
// table implements are those asked for.
TEST(AliasTest, H14MillionsOfLights)
{
    std::mt19937_64 random(3);
    std::lognormal_distribution<double> lognormal(0.0, 3.0);
    std::vector<double> weights(1000000);
    for (double& weight : weights) {
        weight = lognormal(random);
    }
    std::vector<double> shadowed(1000001, 1e-9);
    shadowed[0] = 1.0;
    for (const std::vector<double>& each : {weights, shadowed}) {
        const AliasTable table = buildAliasTable(each);
        const double sum = std::accumulate(each.begin(), each.end(), 0.0);
        double total = 0.0, distance = 0.0;
        for (std::size_t i = 0; i < each.size(); ++i) {
            ASSERT_GT(table.probabilities[i], 0.0) << i;
            total += table.probabilities[i];
            distance += 0.5 * std::abs(table.probabilities[i] - each[i] / sum);
        }
        const double naive = naiveDistance(each, sum);
        printHardCase("H14", each.size() == weights.size() ? "lognormal powers" : "one bright light before dim ones",
                      static_cast<double>(each.size()), "total variation " + figure(distance), "cumulative float sum: " + figure(naive));
        EXPECT_NEAR(total, 1.0, 1e-9);
        EXPECT_LE(distance, 4e-5);
    }
}

}  // namespace
}  // namespace glim
