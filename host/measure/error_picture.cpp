#include "host/measure/error_picture.hpp"

#include "host/image/heat_color.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr double kShareBelowScale = 0.95;

double signedError(const glm::dvec3& x, const glm::dvec3& r, double epsilon)
{
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
        sum += x[c] != r[c] ? (x[c] - r[c]) / std::sqrt(r[c] * r[c] + epsilon) : 0.0;
    }
    return sum / 3.0;
}

// The error that kShareBelowScale of the pixels stay below; if that is 0, as when only a corner differs, the largest.
double chooseScale(const std::vector<double>& errors)
{
    std::vector<double> sizes;
    for (const double error : errors) {
        if (std::isfinite(error)) {
            sizes.push_back(std::abs(error));
        }
    }
    std::sort(sizes.begin(), sizes.end());
    const auto place = static_cast<std::size_t>(kShareBelowScale * static_cast<double>(sizes.size()));
    return sizes.empty() ? 0.0 : sizes[place] > 0 ? sizes[place] : sizes.back();
}

}  // namespace

ErrorPicture drawErrors(const Picture& picture, const Picture& reference, double epsilon)
{
    std::vector<double> errors;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        errors.push_back(signedError(picture.radiance[i], reference.radiance[i], epsilon));
    }
    ErrorPicture result;
    result.scale = chooseScale(errors);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const bool finite = isFinite(picture.radiance[i]) && isFinite(reference.radiance[i]);
        const double scaled = errors[i] == 0 ? 0.0 : errors[i] / result.scale;
        result.pixels.push_back(finite ? differenceColor(scaled) : kMagenta);
    }
    return result;
}

}  // namespace glim
