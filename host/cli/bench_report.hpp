// What `glim bench` prints.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/compare_benches.hpp"

#include <string>

namespace glim {

// A line for every point, what the slope test says, and a last line with the whole in short.
void printBench(const SceneBench& bench);

// Ratios to a baseline, and whether their intervals exclude 1.
void printComparison(const BenchComparison& comparison, const std::string& baseline);

}  // namespace glim
