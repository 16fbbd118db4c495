// Intervals hold the truth as often as they claim: counted over simulated benches, within binomial limits.
#include "host/bench/bootstrap.hpp"
#include "host/measure/confidence.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/noisy_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

namespace glim {
namespace {

constexpr std::size_t kSeeds = 16;
constexpr int kTrials = 1000;

double meanOf(const std::vector<double>& values, const std::vector<std::size_t>& indices)
{
    double sum = 0.0;
    for (const std::size_t i : indices) {
        sum += values[i];
    }
    return sum / static_cast<double>(indices.size());
}

// Errors of renders as skewed as a hard scene's: lognormal, of mean 1 and a coefficient of variation of about 40 %.
std::vector<double> drawErrors(Random& random)
{
    constexpr double kSpread = 0.39;
    std::vector<double> errors;
    for (std::size_t i = 0; i < kSeeds; ++i) {
        errors.push_back(std::exp(kSpread * random.normal() - 0.5 * kSpread * kSpread));
    }
    return errors;
}

void expectCoverage(const std::string& what, int held)
{
    const double share = static_cast<double>(held) / kTrials;
    std::cout << "  " << what << ": " << 100.0 * share << " % of intervals hold the truth\n";
    EXPECT_NEAR(share, 0.95, test::shareMargin(0.95, kTrials)) << what;
}

TEST(Student, LimitsAreTheTabulatedOnes)
{
    EXPECT_NEAR(studentLimit(0.05, 1), 12.7062, 1e-4);
    EXPECT_NEAR(studentLimit(0.05, 2), 4.3027, 1e-4);
    EXPECT_NEAR(studentLimit(0.05, 15), 2.1314, 1e-4);
    EXPECT_NEAR(studentLimit(0.05, 30), 2.0423, 1e-4);
    EXPECT_NEAR(studentLimit(0.001, 15), 4.0728, 1e-4);
    EXPECT_NEAR(studentLimit(0.05, 100000), 1.95999, 1e-4);
}

TEST(Bootstrap, IntervalsOfMeansHoldTheTruthAsOftenAsTheyClaim)
{
    Random random(1);
    int held = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const std::vector<double> errors = drawErrors(random);
        const Interval mean = bootstrap({kSeeds}, [&](const Draw& draw) { return meanOf(errors, draw[0]); });
        EXPECT_LT(mean.low, mean.value);
        EXPECT_GT(mean.high, mean.value);
        held += mean.low <= 1.0 && 1.0 <= mean.high;
    }
    expectCoverage("mean", held);
}

// Both of a pair share most of what varies. An interval that ignored the pairs would be too wide.
TEST(Bootstrap, IntervalsOfRatiosHoldTheTruthPairedOrNot)
{
    Random random(2);
    int paired = 0, apart = 0;
    double pairedWidth = 0.0, apartWidth = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
        const std::vector<double> common = drawErrors(random), below = drawErrors(random);
        std::vector<double> above = common;
        for (double& value : above) {
            value *= 1.0 + 0.05 * random.normal();
        }
        const Interval both = bootstrap({kSeeds}, [&](const Draw& d) { return meanOf(above, d[0]) / meanOf(common, d[0]); });
        const Interval each = bootstrap({kSeeds, kSeeds}, [&](const Draw& d) { return meanOf(above, d[0]) / meanOf(below, d[1]); });
        paired += both.low <= 1.0 && 1.0 <= both.high;
        apart += each.low <= 1.0 && 1.0 <= each.high;
        pairedWidth += both.high - both.low;
        apartWidth += each.high - each.low;
    }
    expectCoverage("ratio, paired", paired);
    expectCoverage("ratio, not paired", apart);
    EXPECT_LT(pairedWidth, 0.3 * apartWidth);
}

TEST(Bootstrap, HasNoIntervalWhereADrawHasNoFigure)
{
    const std::vector<double> values{1.0, 1.0, 1.0, -1.0};
    const Interval none = bootstrap({4}, [&](const Draw& draw) { return std::log(meanOf(values, draw[0])); });
    EXPECT_DOUBLE_EQ(none.value, std::log(0.5));
    EXPECT_TRUE(std::isnan(none.low) && std::isnan(none.high));
}

TEST(Bootstrap, EqualValuesHaveAnIntervalOfNoWidth)
{
    const std::vector<double> values(kSeeds, 3.0);
    const Interval point = bootstrap({kSeeds}, [&](const Draw& draw) { return meanOf(values, draw[0]); });
    EXPECT_EQ(point.low, 3.0);
    EXPECT_EQ(point.high, 3.0);
}

TEST(Bootstrap, JackknifeErrorOfAMeanIsTheTextbooks)
{
    const std::vector<double> values{1.0, 2.0, 4.0, 9.0};  // variance 38/3
    EXPECT_NEAR(jackknifeError(4, [&](const Draw& draw) { return meanOf(values, draw[0]); }), std::sqrt(38.0 / 3.0 / 4.0), 1e-12);
}

}  // namespace
}  // namespace glim
