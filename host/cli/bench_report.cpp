#include "host/cli/bench_report.hpp"

#include "host/bench/summarize_bench.hpp"
#include "host/render/settings.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace glim {
namespace {

std::string intervalText(const Interval& interval, int digits = 3)
{
    if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) {
        return format("%.*g [unknown]", digits, interval.value);
    }
    return format("%.*g [%.*g, %.*g]", digits, interval.value, digits, interval.low, digits, interval.high);
}

void printPoints(const SceneBench& bench, const BenchSummary& summary)
{
    std::cout << "   samples    seconds  on device  relMSE [95 %]                  trimmed    RMSE\n";
    for (const PointSummary& point : summary.points) {
        std::cout << format("%10u %10.4g %10.4g  %-30s %-9.3g  %-9.3g", point.samples, point.seconds, point.kernelSeconds,
                            intervalText(point.relMse).c_str(), point.trimmedRelMse, std::sqrt(std::max(0.0, point.mse.value)))
                  << (point.floorLimited ? "  limited by the reference's noise" : "") << '\n';
    }
    std::cout << "reference " << bench.reference << ": "
              << (bench.floor.known ? format("its noise, relMSE %.3g, is subtracted", bench.floor.relMse)
                                    : std::string("its noise is unknown, nothing is subtracted"))
              << '\n';
}

// Sobol' points gain within blocks but not between them, so no single power fits.
std::string fitText(const SceneBench& bench, const BenchSummary& summary)
{
    if (findSetting(bench.settings, "sampler") != "independent") {
        return "";
    }
    return "relMSE = A n^-p + B with p " + intervalText(summary.fit.power) + ", B " + intervalText(summary.fit.rest) + "; ";
}

void printSlopeTest(const SceneBench& bench, const BenchSummary& summary)
{
    const SlopeTest& test = summary.slopeTest;
    std::cout << fitText(bench, summary)
              << format("slope test: slope %.3g (at most %.3g), bias^2 %.3g (at most %.3g)\n", test.slope, -1.0 + test.slopeMargin,
                        test.bias, test.biasLimit);
    if (!test.biasHolds()) {
        std::cout << "SLOPE TEST FAILS: the renders share an error, so they are biased against that reference\n";
    } else if (!test.slopeHolds()) {
        std::cout << "SLOPE TEST FAILS: the error falls too slowly, so samples repeat or depend on each other\n";
    }
}

std::string efficiencyText(const BenchSummary& summary)
{
    if (!summary.slopeTest.holds()) {
        return "no efficiency since the slope test fails";
    }
    return "efficiency 1/(relMSE s) " + intervalText(summary.efficiency);
}

std::string verdict(const Interval& ratio, int digits = 3)
{
    return intervalText(ratio, digits) + (excludesOne(ratio) ? ", excludes 1\n" : ", does not exclude 1\n");
}

}  // namespace

void printBench(const SceneBench& bench)
{
    const BenchSummary summary = summarizeBench(bench);
    printPoints(bench, summary);
    printSlopeTest(bench, summary);
    const PointSummary& last = summary.points.back();
    const StartUp& start = bench.startUp;
    std::cout << bench.scene << format(": %ux%u, relMSE ", bench.width, bench.height) << intervalText(last.relMse)
              << format(" after %.3g s (%u samples per pixel, %zu seeds), slope ", last.seconds, last.samples, bench.seeds.size())
              << intervalText(summary.slope) << ", " << efficiencyText(summary)
              << format(", %.3g Msamples/s after %.2f s to start, on ", 1e-6 * summary.samplesPerSecond,
                        start.load + start.build + start.upload + start.compile)
              << bench.device << '\n';
}

void printComparison(const BenchComparison& comparison, const SceneBench& baseline, const std::string& file,
                     const std::string& whyNotByTurns)
{
    const bool byTurns = whyNotByTurns.empty();
    const auto timed = [&](const Interval& ratio) { return byTurns ? verdict(ratio) : intervalText(ratio) + '\n'; };
    const auto byCpu = [&](const std::optional<Interval>& ratio) { return ratio ? timed(*ratio) : "unknown\n"; };
    std::cout << "against " << file << format(" after %u samples, seeds ", comparison.samples)
              << (comparison.paired ? "paired, " : "not paired, ") << (byTurns ? "by turns" : "not by turns") << ":\n  mean x              "
              << verdict(comparison.mean, 6) << "  MSE x               " << verdict(comparison.mse) << "  relMSE x            "
              << verdict(comparison.error) << "  samples a second x  " << timed(comparison.samplesPerSecond) << "    by CPU seconds x  "
              << byCpu(comparison.samplesPerCpuSecond) << "  efficiency x        " << timed(comparison.efficiency)
              << "    by CPU seconds x  " << byCpu(comparison.cpuEfficiency) << "  time to its error x " << timed(comparison.timeToError);
    if (byTurns) {
        std::cout << "  not excluded: a load that slows one of the two more than the other, as where both wait for memory\n";
    } else {
        std::cout << "  not excluded: what slowed the machine in one of the two runs. The baseline's times are those of its own run, by "
                  << baseline.version << " on " << baseline.device << ", because " << whyNotByTurns
                  << ". CPU seconds suffer less from load, but as much from a slower clock.\n";
    }
}

}  // namespace glim
