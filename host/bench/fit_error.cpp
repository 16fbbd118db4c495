#include "host/bench/fit_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr double kMinPower = 0.25, kMaxPower = 4.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct LinearFit {
    FittedError fitted;
    double squares;  // of the relative deviations
};

// For a given power, factor and rest are those of a line.
LinearFit fitLine(const std::vector<double>& samples, const std::vector<double>& errors, double power)
{
    double xx = 0.0, xo = 0.0, oo = 0.0, xSum = 0.0, oSum = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double x = std::pow(samples[i], -power) / errors[i], one = 1.0 / errors[i];
        xx += x * x;
        xo += x * one;
        oo += one * one;
        xSum += x;
        oSum += one;
    }
    const double determinant = xx * oo - xo * xo;
    const double factor = (xSum * oo - oSum * xo) / determinant, rest = (xx * oSum - xo * xSum) / determinant;
    double squares = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double deviation = (factor * std::pow(samples[i], -power) + rest) / errors[i] - 1.0;
        squares += deviation * deviation;
    }
    return {{factor, power, rest}, squares};
}

bool arePositive(const std::vector<double>& errors)
{
    return std::all_of(errors.begin(), errors.end(), [](double error) { return error > 0.0; });
}

}  // namespace

FittedError fitError(const std::vector<double>& samples, const std::vector<double>& errors)
{
    if (!arePositive(errors)) {
        return {kUnknown, kUnknown, kUnknown};
    }
    constexpr int kSteps = 30;
    const double stride = std::log(kMaxPower / kMinPower) / kSteps;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kSteps; ++i) {
        const double squares = fitLine(samples, errors, kMinPower * std::exp(stride * i)).squares;
        if (squares < least) {
            best = i;
            least = squares;
        }
    }
    // Between its neighbours by golden-section search (Kiefer 1953).
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = kMinPower * std::exp(stride * std::max(best - 1, 0));
    double high = kMinPower * std::exp(stride * std::min(best + 1, kSteps));
    for (int i = 0; i < 25; ++i) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (fitLine(samples, errors, left).squares < fitLine(samples, errors, right).squares) {
            high = right;
        } else {
            low = left;
        }
    }
    return fitLine(samples, errors, 0.5 * (low + high)).fitted;
}

double fitSlope(const std::vector<double>& samples, const std::vector<double>& errors)
{
    if (!arePositive(errors)) {
        return kUnknown;
    }
    const double n = static_cast<double>(samples.size());
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double a = std::log(samples[i]), b = std::log(errors[i]);
        x += a / n;
        y += b / n;
        xx += a * a / n;
        xy += a * b / n;
    }
    return (xy - x * y) / (xx - x * x);
}

}  // namespace glim
