#include "host/bench/summarize_bench.hpp"

#include "host/bench/fit_error.hpp"
#include "host/measure/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr double kFloorShare = 0.01;  // of an error, above which the floor limits what is known of it
constexpr double kTestLevel = 1e-3;   // of either part of the slope test, two-sided; fails on one side only

std::vector<double> samplesOf(const SceneBench& bench)
{
    std::vector<double> samples;
    for (const BenchPoint& point : bench.points) {
        samples.push_back(point.samples);
    }
    return samples;
}

// relMSE of every point less the floor.
std::vector<double> errorsOver(const SceneBench& bench, const std::vector<std::size_t>& indices)
{
    std::vector<double> errors;
    for (const BenchPoint& point : bench.points) {
        errors.push_back(meanOver(point.relMse, indices) - bench.floor.relMse);
    }
    return errors;
}

PointSummary summarizePoint(const BenchPoint& point, const Floor& floor)
{
    const auto meanLess = [&](const std::vector<double>& errors, double noise) {
        return bootstrap({errors.size()}, [&](const Draw& draw) { return meanOver(errors, draw[0]) - noise; });
    };
    PointSummary summary;
    summary.samples = point.samples;
    summary.seconds = computeMedian(point.seconds);
    summary.kernelSeconds = computeMedian(point.kernelSeconds);
    summary.mse = meanLess(point.mse, floor.mse);
    summary.relMse = meanLess(point.relMse, floor.relMse);
    for (const double error : point.trimmedRelMse) {
        summary.trimmedRelMse += error / static_cast<double>(point.trimmedRelMse.size());
    }
    summary.floorLimited = floor.relMse > kFloorShare * summary.relMse.value;
    return summary;
}

ErrorFit fitBench(const SceneBench& bench)
{
    const std::vector<double> samples = samplesOf(bench);
    const auto fitted = [&](const Draw& draw) { return fitError(samples, errorsOver(bench, draw[0])); };
    ErrorFit fit;
    fit.power = bootstrap({bench.seeds.size()}, [&](const Draw& draw) { return fitted(draw).power; });
    fit.rest = bootstrap({bench.seeds.size()}, [&](const Draw& draw) { return fitted(draw).rest; });
    std::vector<std::size_t> all(bench.seeds.size());
    std::generate(all.begin(), all.end(), [i = std::size_t{0}]() mutable { return i++; });
    fit.factor = fitted({all}).factor;
    return fit;
}

Interval efficiencyBy(const SceneBench& bench, const std::vector<double>& seconds)
{
    const BenchPoint& last = bench.points.back();
    if (computeMedian(seconds) <= 0.0) {
        constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
        return {kMissing, kMissing, kMissing};
    }
    return bootstrap({bench.seeds.size()}, [&](const Draw& draw) {
        const double error = meanOver(last.relMse, draw[0]) - bench.floor.relMse;
        return 1.0 / (error * medianOver(seconds, draw[0]));
    });
}

const BenchPoint& pointAt(const SceneBench& bench, std::uint32_t samples)
{
    return *std::find_if(bench.points.begin(), bench.points.end(), [samples](const BenchPoint& point) { return point.samples == samples; });
}

// One bench's figures, for the renders of a draw.
struct Side {
    double error, mse, mean, seconds, cpuSeconds, slope;
};

Side sideOf(const SceneBench& bench, const BenchPoint& point, const std::vector<std::size_t>& indices)
{
    return {meanOver(point.relMse, indices) - bench.floor.relMse,
            meanOver(point.mse, indices) - bench.floor.mse,
            meanOver(point.mean, indices),
            medianOver(point.seconds, indices),
            medianOver(point.cpuSeconds, indices),
            slopeOver(bench, indices)};
}

}  // namespace

double meanOver(const std::vector<double>& values, const std::vector<std::size_t>& indices)
{
    double sum = 0.0;
    for (const std::size_t index : indices) {
        sum += values[index];
    }
    return sum / static_cast<double>(indices.size());
}

double computeMedian(const std::vector<double>& values)
{
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
}

double medianOver(const std::vector<double>& values, const std::vector<std::size_t>& indices)
{
    std::vector<double> chosen;
    for (const std::size_t index : indices) {
        chosen.push_back(values[index]);
    }
    return computeMedian(chosen);
}

double slopeOver(const SceneBench& bench, const std::vector<std::size_t>& indices)
{
    return fitSlope(samplesOf(bench), errorsOver(bench, indices));
}

BenchSummary summarizeBench(const SceneBench& bench)
{
    const std::size_t seeds = bench.seeds.size();
    const auto slope = [&](const Draw& draw) { return slopeOver(bench, draw[0]); };
    BenchSummary summary;
    for (const BenchPoint& point : bench.points) {
        summary.points.push_back(summarizePoint(point, bench.floor));
    }
    summary.slope = bootstrap({seeds}, slope);
    summary.fit = fitBench(bench);
    const double limit = studentLimit(kTestLevel, seeds - 1);
    summary.slopeTest = {summary.slope.value, limit * jackknifeError(seeds, slope), bench.bias.squared, limit * bench.bias.error};
    summary.efficiency = efficiencyBy(bench, bench.points.back().seconds);
    summary.kernelEfficiency = efficiencyBy(bench, bench.points.back().kernelSeconds);
    summary.samplesPerSecond =
        static_cast<double>(bench.width) * bench.height * bench.points.back().samples / summary.points.back().seconds;
    return summary;
}

BenchComparison compareBenches(const SceneBench& bench, const SceneBench& baseline)
{
    BenchComparison comparison;
    comparison.samples = std::min(bench.points.back().samples, baseline.points.back().samples);
    comparison.paired = bench.seeds == baseline.seeds;
    const BenchPoint& mine = pointAt(bench, comparison.samples);
    const BenchPoint& other = pointAt(baseline, comparison.samples);
    std::vector<std::size_t> sizes{bench.seeds.size()};
    if (!comparison.paired) {
        sizes.push_back(baseline.seeds.size());
    }
    const auto ratio = [&](auto figure) {
        return bootstrap(sizes,
                         [&](const Draw& draw) { return figure(sideOf(bench, mine, draw.front()), sideOf(baseline, other, draw.back())); });
    };
    comparison.efficiency = ratio([](const Side& a, const Side& b) { return b.error * b.seconds / (a.error * a.seconds); });
    comparison.error = ratio([](const Side& a, const Side& b) { return a.error / b.error; });
    comparison.mse = ratio([](const Side& a, const Side& b) { return a.mse / b.mse; });
    comparison.mean = ratio([](const Side& a, const Side& b) { return a.mean / b.mean; });
    comparison.samplesPerSecond = ratio([](const Side& a, const Side& b) { return b.seconds / a.seconds; });
    if (computeMedian(mine.cpuSeconds) > 0.0 && computeMedian(other.cpuSeconds) > 0.0) {
        comparison.cpuEfficiency = ratio([](const Side& a, const Side& b) { return b.error * b.cpuSeconds / (a.error * a.cpuSeconds); });
        comparison.samplesPerCpuSecond = ratio([](const Side& a, const Side& b) { return b.cpuSeconds / a.cpuSeconds; });
    }
    comparison.timeToError =
        ratio([](const Side& a, const Side& b) { return a.seconds / b.seconds * std::pow(b.error / a.error, 1.0 / a.slope); });
    return comparison;
}

bool excludesOne(const Interval& interval) { return interval.low > 1.0 || interval.high < 1.0; }

}  // namespace glim
