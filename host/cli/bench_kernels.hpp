// `glim bench --kernels`.
#pragma once

#include "host/cli/bench_options.hpp"
#include "host/error.hpp"

namespace glim {

// Prints a table for each scene, or of one made in memory, and writes it to options.output where that was asked for.
ExitCode runBenchKernels(const BenchOptions& options);

}  // namespace glim
