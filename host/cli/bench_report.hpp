// The report of `glim bench`.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/bench/summarize_bench.hpp"

#include <string>

namespace glim {

// Prints a line for every point, the result of the slope test, and a summary.
void printBench(const SceneBench& bench);

// Ratios to a baseline, whether their intervals exclude 1 (times only if they were measured by turns), and what the intervals do not
// account for. `whyNotByTurns`: why the baseline's figures are those of its file, as in "it has the same options"; empty if both were
// rendered now, by turns.
void printComparison(const BenchComparison& comparison, const SceneBench& baseline, const std::string& file,
                     const std::string& whyNotByTurns);

}  // namespace glim
