// Figures of a bench, with intervals over its seeds.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/bootstrap.hpp"

namespace glim {

struct PointSummary {
    std::uint32_t samples = 0;
    double seconds = 0.0, kernelSeconds = 0.0;  // medians
    Interval mse, relMse;                       // of the mean, less the floor
    double trimmedRelMse = 0.0;                 // nothing taken off
    bool floorLimited = false;                  // the floor is more than 1 % of relMse
};

// relMSE = factor * samples^-power + rest.
struct ErrorFit {
    double factor = 0.0;
    Interval power, rest;
};

// Of independent samples the error falls as n^-1, of better points faster. Shallower is a bias or random numbers that repeat.
struct SlopeTest {
    double slope = 0.0, slopeReach = 0.0;  // fails above -1 + slopeReach
    double bias = 0.0, biasReach = 0.0;    // relMSE; fails above biasReach
    bool slopeHolds() const { return slope <= -1.0 + slopeReach; }
    bool biasHolds() const { return bias <= biasReach; }
    bool holds() const { return slopeHolds() && biasHolds(); }
};

struct BenchSummary {
    std::vector<PointSummary> points;
    Interval slope;  // of log relMSE over log samples, least squares
    ErrorFit fit;
    SlopeTest slopeTest;
    // 1 / (relMSE * seconds) of the last point, by the clock and by the kernels' time (0: unknown). Only of what is unbiased.
    Interval efficiency, kernelEfficiency;
    double samplesPerSecond = 0.0;
};

BenchSummary summarizeBench(const SceneBench& bench);

double medianOf(const std::vector<double>& values);
// Of the values that `indices` name.
double meanOver(const std::vector<double>& values, const std::vector<std::size_t>& indices);
double medianOver(const std::vector<double>& values, const std::vector<std::size_t>& indices);

// Slope of log relMSE over log samples, of the renders that `indices` name; NaN if the floor is above an error.
double slopeOver(const SceneBench& bench, const std::vector<std::size_t>& indices);

}  // namespace glim
