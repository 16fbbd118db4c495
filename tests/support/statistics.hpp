// Tests of hypotheses about what kernels draw. Family of the whole suite: level 1e-3, split by Sidak among the comparisons
// that a test says it makes.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace glim {

// tools/test --long (GLIM_LONG=1) repeats randomised tests with this many seeds instead of one.
int testRounds();

// P(X >= x) for chi-square with `freedom` degrees.
double chiSquareTail(double x, double freedom);

// Pearson's test of counts against expected ones; cells with less than 5 expected are pooled. `tests`: comparisons in the
// family. Prints the p-value.
void expectCounts(const std::string& what, std::span<const double> counts, std::span<const double> expected,
                  std::size_t tests);

// The mean of independent values against its truth, with the standard error from the values. Prints z.
void expectSampleMean(const std::string& what, std::span<const double> values, double truth, std::size_t tests);

// Two series that should be independent: |correlation| * sqrt(n) against the normal limit. Returns it.
double correlationScore(std::span<const double> a, std::span<const double> b);

// The largest |z| that a family of `tests` comparisons allows at its level.
double scoreLimit(std::size_t tests);

}  // namespace glim
