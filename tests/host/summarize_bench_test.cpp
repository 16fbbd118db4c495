// Slope, floor and efficiency of simulated benches; the slope test finds the flaws that are planted.
#include "host/bench/summarize_bench.hpp"
#include "host/bench/fit_error.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/noisy_picture.hpp"
#include "tests/support/simulated_bench.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim {
namespace {

using test::Flaw;
using test::simulateBench;

constexpr int kTrials = 100;

TEST(FitError, FindsFactorPowerAndRest)
{
    std::vector<double> samples, errors, powers;
    for (double n = 1.0; n <= 64.0; n *= 2.0) {
        samples.push_back(n);
        errors.push_back(3.0 * std::pow(n, -1.5) + 0.01);
        powers.push_back(3.0 * std::pow(n, -1.5));
    }
    const FittedError fit = fitError(samples, errors);
    EXPECT_NEAR(fit.factor, 3.0, 1e-3);
    EXPECT_NEAR(fit.power, 1.5, 1e-3);
    EXPECT_NEAR(fit.rest, 0.01, 1e-4);
    EXPECT_NEAR(fitSlope(samples, powers), -1.5, 1e-12);
    errors[2] = -0.1;
    EXPECT_TRUE(std::isnan(fitError(samples, errors).power) && std::isnan(fitSlope(samples, errors)));
}

TEST(MeasureError, FloorIsWhatTheReferenceAddsAndBiasIsWhatSeedsShare)
{
    const SceneBench bench = simulateBench(Flaw::None, 1);
    // A term falls by 2 (r - 1), whose mean over pixels and channels is left.
    const double left = 2.0 / std::sqrt(3.0 * test::kBenchSide * test::kBenchSide * test::kReferenceSamples);
    EXPECT_NEAR(bench.floor.relMse * test::kReferenceSamples, 1.0 / 1.01, 4.0 * left);
    EXPECT_NEAR(bench.floor.relMseError, bench.floor.relMse * std::sqrt(2.0 / 256), 1e-3 * bench.floor.relMse);
    EXPECT_FALSE(measureFloor({1, 1, {glm::vec3(1.0F)}, {}}).known);
    std::vector<double> biases;
    for (std::uint64_t trial = 0; trial < 30; ++trial) {
        biases.push_back(simulateBench(Flaw::None, trial).bias.squared);
    }
    expectSampleMean("bias^2 of what has none", biases, 0.0, 4);
    const Bias bias = simulateBench(Flaw::Bias, 1).bias;
    EXPECT_NEAR(bias.squared, 0.01 / 1.01, 4.0 * bias.error);  // a tenth of the light too much
    EXPECT_GT(bias.squared, 10.0 * bias.error);
}

TEST(MeasureError, TrimmedIsWithoutTheWorstPixels)
{
    const Picture truth = test::makeTruth(50, 40);
    Picture picture = truth;
    picture.radiance[123].r += 100.0F;
    EXPECT_GT(measureError(picture, truth).relMse, 0.1);
    EXPECT_EQ(measureError(picture, truth).trimmedRelMse, 0.0);
    picture.radiance[5].g += 1.0F;
    picture.radiance[6].g += 1.0F;  // 3 of 2000 pixels, of which 2 are dropped
    EXPECT_GT(measureError(picture, truth).trimmedRelMse, 0.0);
}

TEST(SummarizeBench, SlopeOfIndependentSamplesIsMinusOneAsOftenAsItClaims)
{
    int held = 0, shallow = 0;
    std::vector<double> slopes;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
        const SceneBench bench = simulateBench(Flaw::None, trial);
        const auto slope = [&](const Draw& draw) { return slopeOver(bench, draw[0]); };
        const Interval interval = bootstrap({bench.seeds.size()}, slope);
        slopes.push_back(interval.value);
        held += interval.low <= -1.0 && -1.0 <= interval.high;
        shallow += interval.value > -1.0 + 4.0728 * jackknifeError(bench.seeds.size(), slope);
    }
    std::cout << "  " << held << " of " << kTrials << " intervals hold -1\n";
    EXPECT_NEAR(static_cast<double>(held) / kTrials, 0.95, test::shareMargin(0.95, kTrials));
    EXPECT_EQ(shallow, 0);
    expectSampleMean("slope", slopes, -1.0, 4);
}

TEST(SummarizeBench, SlopeTestFindsBiasAndSamplesThatRepeat)
{
    for (const Flaw flaw : {Flaw::None, Flaw::Bias, Flaw::RepeatsAfter16, Flaw::SameInEverySeed}) {
        for (std::uint64_t trial = 0; trial < 3; ++trial) {
            const SlopeTest test = summarizeBench(simulateBench(flaw, trial)).slopeTest;
            EXPECT_EQ(test.holds(), flaw == Flaw::None) << static_cast<int>(flaw);
            // Samples that repeat within a seed give no error that seeds share.
            EXPECT_EQ(test.biasHolds(), flaw == Flaw::None || flaw == Flaw::RepeatsAfter16) << static_cast<int>(flaw);
            if (flaw != Flaw::SameInEverySeed) {  // whose slope has no known error
                EXPECT_EQ(test.slopeHolds(), flaw == Flaw::None) << static_cast<int>(flaw);
            }
        }
    }
}

TEST(SummarizeBench, TakesTheFloorOffAndMarksWhatItLimits)
{
    SceneBench bench = simulateBench(Flaw::None, 1);
    const BenchSummary summary = summarizeBench(bench);
    const PointSummary& last = summary.points.back();
    EXPECT_NEAR(last.relMse.value, 1.0 / 1.01 / 64, 0.1 / 64);
    EXPECT_FALSE(last.floorLimited);
    EXPECT_NEAR(summary.efficiency.value, 1.0 / (last.relMse.value * last.seconds), 1e-9 * summary.efficiency.value);
    EXPECT_NEAR(summary.kernelEfficiency.value, summary.efficiency.value / 0.9, 1e-9 * summary.efficiency.value);
    EXPECT_NEAR(summary.samplesPerSecond, 1e6, 5e4);
    bench.floor.relMse *= 4.0;
    const BenchSummary limited = summarizeBench(bench);
    EXPECT_NEAR(limited.points.back().relMse.value, last.relMse.value - 0.75 * bench.floor.relMse, 1e-12);
    EXPECT_TRUE(limited.points.back().floorLimited);
    EXPECT_FALSE(limited.points.front().floorLimited);
}

// A bias of one in a thousand shows between renders of the same seeds, where another seed's mean is 1 % off.
TEST(CompareBenches, FindsADifferenceOfMeansAndOfErrors)
{
    SceneBench darker = simulateBench(Flaw::None, 1);
    Random random(3);
    for (std::size_t i = 0; i < darker.seeds.size(); ++i) {
        darker.points.back().mean[i] *= 0.999 + 1e-4 * random.normal();
        darker.points.back().mse[i] = 2.0 * (darker.points.back().mse[i] - darker.floor.mse) + darker.floor.mse;
    }
    const BenchComparison paired = compareBenches(darker, simulateBench(Flaw::None, 1));
    EXPECT_NEAR(paired.mean.value, 0.999, 1e-4);
    EXPECT_TRUE(excludesOne(paired.mean));
    EXPECT_LT(paired.mean.high - paired.mean.low, 3e-4);
    EXPECT_NEAR(paired.mse.value, 2.0, 1e-6);
    EXPECT_TRUE(excludesOne(paired.mse));
    EXPECT_FALSE(excludesOne(paired.error));
}

// The same errors in .8 of the time, against the same seeds and against other seeds.
TEST(CompareBenches, FindsWhatIsFasterAndClaimsNothingElse)
{
    SceneBench faster = simulateBench(Flaw::None, 1);
    for (BenchPoint& point : faster.points) {
        for (double& seconds : point.seconds) {
            seconds *= 0.8;
        }
    }
    const BenchComparison paired = compareBenches(faster, simulateBench(Flaw::None, 1));
    EXPECT_TRUE(paired.paired);
    EXPECT_EQ(paired.samples, 64U);
    EXPECT_NEAR(paired.samplesPerSecond.value, 1.25, 1e-9);
    EXPECT_NEAR(paired.efficiency.value, 1.25, 1e-9);
    EXPECT_NEAR(paired.timeToError.value, 0.8, 1e-9);
    EXPECT_TRUE(excludesOne(paired.samplesPerSecond) && excludesOne(paired.efficiency) && excludesOne(paired.timeToError));
    EXPECT_FALSE(excludesOne(paired.error) || excludesOne(paired.mse) || excludesOne(paired.mean));
    // By CPU seconds both took the same: a load made one of them slower.
    EXPECT_NEAR(paired.samplesPerCpuSecond->value, 1.0, 1e-9);
    EXPECT_NEAR(paired.cpuEfficiency->value, 1.0, 1e-9);
    EXPECT_FALSE(excludesOne(*paired.cpuEfficiency));
    SceneBench older = simulateBench(Flaw::None, 1);
    for (BenchPoint& point : older.points) {
        point.cpuSeconds.assign(point.cpuSeconds.size(), 0.0);
    }
    EXPECT_FALSE(compareBenches(faster, older).cpuEfficiency);
    EXPECT_FALSE(compareBenches(older, faster).samplesPerCpuSecond);
    SceneBench other = simulateBench(Flaw::None, 2);
    for (std::uint32_t& seed : other.seeds) {
        seed += 100;
    }
    other.points.pop_back();  // to 32 samples only
    const BenchComparison apart = compareBenches(faster, other);
    EXPECT_FALSE(apart.paired);
    EXPECT_EQ(apart.samples, 32U);
    EXPECT_TRUE(excludesOne(apart.samplesPerSecond));
    EXPECT_FALSE(excludesOne(apart.error));
}

}  // namespace
}  // namespace glim
