// How an error falls with the number of samples.
#pragma once

#include <vector>

namespace glim {

// error = factor * samples^-power + rest.
struct FittedError {
    double factor, power, rest;
};

// Least squares of relative deviations, over powers from .25 to 4. At least four points; errors above 0, else NaN.
FittedError fitError(const std::vector<double>& samples, const std::vector<double>& errors);

// Slope of the least-squares line of log(errors) over log(samples); NaN unless all errors are above 0.
double fitSlope(const std::vector<double>& samples, const std::vector<double>& errors);

}  // namespace glim
