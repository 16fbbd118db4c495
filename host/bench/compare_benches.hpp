// Two benches of one picture: which reaches an error sooner?
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/bootstrap.hpp"

namespace glim {

// Ratios, of the first bench to the second, after as many samples as both have.
struct BenchComparison {
    std::uint32_t samples = 0;
    bool paired = false;      // drawn in pairs, since both have the same seeds
    Interval efficiency;      // 1 / (relMSE * seconds)
    Interval error;           // relMSE
    Interval mse;
    Interval mean;            // of the pictures: the same but for a bias
    Interval samplesPerSecond;
    Interval timeToError;     // until the first has the second's error, along its slope
};

BenchComparison compareBenches(const SceneBench& bench, const SceneBench& baseline);

bool excludesOne(const Interval& interval);

}  // namespace glim
