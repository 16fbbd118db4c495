#include "host/bench/compare_benches.hpp"

#include "host/bench/summarize_bench.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

const BenchPoint& pointAt(const SceneBench& bench, std::uint32_t samples)
{
    return *std::find_if(bench.points.begin(), bench.points.end(),
                         [samples](const BenchPoint& point) { return point.samples == samples; });
}

// Of one bench, for the renders of a draw.
struct Side {
    double error, mse, mean, seconds, slope;
};

Side sideOf(const SceneBench& bench, const BenchPoint& point, const std::vector<std::size_t>& indices)
{
    return {meanOver(point.relMse, indices) - bench.floor.relMse, meanOver(point.mse, indices) - bench.floor.mse,
            meanOver(point.mean, indices), medianOver(point.seconds, indices), slopeOver(bench, indices)};
}

}  // namespace

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
        return bootstrap(sizes, [&](const Draw& draw) {
            return figure(sideOf(bench, mine, draw.front()), sideOf(baseline, other, draw.back()));
        });
    };
    comparison.efficiency = ratio([](const Side& a, const Side& b) { return b.error * b.seconds / (a.error * a.seconds); });
    comparison.error = ratio([](const Side& a, const Side& b) { return a.error / b.error; });
    comparison.mse = ratio([](const Side& a, const Side& b) { return a.mse / b.mse; });
    comparison.mean = ratio([](const Side& a, const Side& b) { return a.mean / b.mean; });
    comparison.samplesPerSecond = ratio([](const Side& a, const Side& b) { return b.seconds / a.seconds; });
    comparison.timeToError = ratio([](const Side& a, const Side& b) {
        return a.seconds / b.seconds * std::pow(b.error / a.error, 1.0 / a.slope);
    });
    return comparison;
}

bool excludesOne(const Interval& interval) { return interval.low > 1.0 || interval.high < 1.0; }

}  // namespace glim
