// Figures of a bench with intervals over its seeds, and the comparison of two benches.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/bootstrap.hpp"

#include <optional>

namespace glim {

struct PointSummary {
    std::uint32_t samples = 0;
    double seconds = 0.0, kernelSeconds = 0.0;  // medians
    Interval mse, relMse;                       // of the mean, minus the floor
    double trimmedRelMse = 0.0;                 // the floor is not subtracted
    bool floorLimited = false;                  // the floor is more than 1 % of relMse
};

// relMSE = factor * samples^-power + rest.
struct ErrorFit {
    double factor = 0.0;
    Interval power, rest;
};

// With independent samples the error falls as n^-1, with better points faster. A shallower slope means a bias or repeated samples.
struct SlopeTest {
    double slope = 0.0, slopeMargin = 0.0;  // fails above -1 + slopeMargin
    double bias = 0.0, biasLimit = 0.0;     // relMSE; fails above biasLimit
    bool slopeHolds() const { return slope <= -1.0 + slopeMargin; }
    bool biasHolds() const { return bias <= biasLimit; }
    bool holds() const { return slopeHolds() && biasHolds(); }
};

struct BenchSummary {
    std::vector<PointSummary> points;
    Interval slope;  // of log relMSE over log samples, least squares
    ErrorFit fit;
    SlopeTest slopeTest;
    // 1 / (relMSE * seconds) of the last point, by wall-clock and by kernel time (NaN: unknown). Only meaningful if unbiased.
    Interval efficiency, kernelEfficiency;
    double samplesPerSecond = 0.0;
};

BenchSummary summarizeBench(const SceneBench& bench);

double computeMedian(const std::vector<double>& values);
// Over the values that `indices` select.
double meanOver(const std::vector<double>& values, const std::vector<std::size_t>& indices);
double medianOver(const std::vector<double>& values, const std::vector<std::size_t>& indices);

// Slope of log relMSE over log samples, of the renders that `indices` select; NaN if the floor is above an error.
double slopeOver(const SceneBench& bench, const std::vector<std::size_t>& indices);

// Ratios, of the first bench to the second, after as many samples as both have.
struct BenchComparison {
    std::uint32_t samples = 0;
    bool paired = false;  // drawn in pairs, since both have the same seeds
    Interval efficiency;  // 1 / (relMSE * seconds)
    Interval error;       // relMSE
    Interval mse;
    Interval mean;  // of the pictures: 1 unless one is biased
    Interval samplesPerSecond;
    std::optional<Interval> cpuEfficiency, samplesPerCpuSecond;  // by CPU seconds, where both benches know theirs
    Interval timeToError;                                        // until the first has the second's error, extrapolated along its slope
};

BenchComparison compareBenches(const SceneBench& bench, const SceneBench& baseline);

bool excludesOne(const Interval& interval);

}  // namespace glim
