// The report of `glim bench`.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/summarize_bench.hpp"

#include <string>

namespace glim {

// Prints a line for every point, the result of the slope test, and a summary.
void printBench(const SceneBench& bench);

// Ratios to a baseline, and whether their intervals exclude 1.
void printComparison(const BenchComparison& comparison, const std::string& baseline);

}  // namespace glim
