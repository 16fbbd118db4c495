// Hypothesis tests of random draws. The level of 1e-3 is divided by Sidak's rule among the comparisons that a test names.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace glim {

// The number of seeds of a random test: 25 with tools/test --long (GLIM_LONG=1), otherwise 1.
int testRounds();

// P(X >= x) for a chi-square distribution with `freedom` degrees of freedom.
double chiSquareTail(double x, double freedom);

// Pearson's chi-square of counts against expected counts.
struct ChiSquare {
    double statistic, cells, p;
    double impossible;  // counted where none is expected
};
ChiSquare computeChiSquare(std::span<const double> counts, std::span<const double> expected);

// Pearson's test of counts against expected counts. Cells with an expected count below 5 are pooled. `tests` is the number of
// comparisons of the family. Prints the p-value.
void expectCounts(const std::string& what, std::span<const double> counts, std::span<const double> expected, std::size_t tests);

// Compares the mean of independent values with its true value; the standard error comes from the values. Prints z.
void expectSampleMean(const std::string& what, std::span<const double> values, double truth, std::size_t tests);

// |correlation| * sqrt(n) of two series, which is normally distributed if they are independent.
double correlationScore(std::span<const double> a, std::span<const double> b);

// The least p-value that a family of `tests` comparisons allows.
double familyLevel(std::size_t tests);

// The largest |z| that a family of `tests` comparisons allows.
double scoreLimit(std::size_t tests);

}  // namespace glim
