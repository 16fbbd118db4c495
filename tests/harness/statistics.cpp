#include "tests/harness/statistics.hpp"

#include "host/measure/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numeric>

namespace glim {
namespace {

constexpr double kFamilyLevel = 1e-3;

// Lower regularised incomplete gamma by its series (Abramowitz and Stegun 6.5.29); for x < a + 1.
double gammaSeries(double a, double x)
{
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; term > sum * 1e-16; n += 1.0) {
        term *= x / n;
        sum += term;
    }
    return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

// Upper one by its continued fraction (6.5.31), evaluated by Lentz's method; for x >= a + 1.
double gammaFraction(double a, double x)
{
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, value = d;
    for (int i = 1; i < 100000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        value *= c * d;
        if (std::abs(c * d - 1.0) < 1e-15) {
            break;
        }
    }
    return value * std::exp(a * std::log(x) - x - std::lgamma(a));
}

}  // namespace

int testRounds() { return std::getenv("GLIM_LONG") != nullptr ? 25 : 1; }

double chiSquareTail(double x, double freedom)
{
    const double a = 0.5 * freedom, half = 0.5 * x;
    if (!(half > 0.0)) {
        return 1.0;
    }
    return half < a + 1.0 ? 1.0 - gammaSeries(a, half) : gammaFraction(a, half);
}

ChiSquare computeChiSquare(std::span<const double> counts, std::span<const double> expected)
{
    double statistic = 0.0, pooledCount = 0.0, pooledExpected = 0.0;
    double cells = 0.0;
    const auto add = [&](double count, double truth) {
        statistic += (count - truth) * (count - truth) / truth;
        cells += 1.0;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] < 5.0) {
            pooledCount += counts[i];
            pooledExpected += expected[i];
        } else {
            add(counts[i], expected[i]);
        }
    }
    if (pooledExpected > 0.0) {
        add(pooledCount, pooledExpected);
    }
    return {statistic, cells, chiSquareTail(statistic, cells - 1.0), pooledExpected == 0.0 ? pooledCount : 0.0};
}

void expectCounts(const std::string& what, std::span<const double> counts, std::span<const double> expected, std::size_t tests)
{
    const ChiSquare test = computeChiSquare(counts, expected);
    EXPECT_EQ(test.impossible, 0.0) << what << ": in impossible cells";
    std::cout << "  " << what << ": chi-square " << test.statistic << " with " << test.cells << " cells, p = " << test.p << '\n';
    EXPECT_GE(test.p, familyLevel(tests)) << what;
}

double familyLevel(std::size_t tests) { return sidakLevel(kFamilyLevel, tests); }

void expectSampleMean(const std::string& what, std::span<const double> values, double truth, std::size_t tests)
{
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    const double squares = std::accumulate(values.begin(), values.end(), 0.0,
                                           [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
    const double error = std::sqrt(squares / (n - 1.0) / n);
    std::cout << "  " << what << ": mean " << mean << ", expected " << truth << ", z = " << (mean - truth) / error << '\n';
    EXPECT_LE(std::abs(mean - truth), scoreLimit(tests) * error) << what;
}

double correlationScore(std::span<const double> a, std::span<const double> b)
{
    const double n = static_cast<double>(a.size());
    const double meanA = std::accumulate(a.begin(), a.end(), 0.0) / n;
    const double meanB = std::accumulate(b.begin(), b.end(), 0.0) / n;
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - meanA) * (b[i] - meanB);
        aa += (a[i] - meanA) * (a[i] - meanA);
        bb += (b[i] - meanB) * (b[i] - meanB);
    }
    return std::abs(ab) / std::sqrt(aa * bb) * std::sqrt(n);
}

double scoreLimit(std::size_t tests) { return twoSidedLimit(sidakLevel(kFamilyLevel, tests)); }

}  // namespace glim
