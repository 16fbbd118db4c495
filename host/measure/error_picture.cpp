#include "host/measure/error_picture.hpp"

#include "shaders/shared/display_colors.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr double kShareBelowScale = 0.95;

}  // namespace

double chooseErrorScale(const Picture& picture, const Picture& reference, double relative, double epsilon)
{
    std::vector<double> sizes;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        const double error = signedDifference(picture.radiance[i], reference.radiance[i], relative, epsilon);
        if (std::isfinite(error)) {
            sizes.push_back(std::abs(error));
        }
    }
    if (sizes.empty()) {
        return 0.0;
    }
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(kShareBelowScale * static_cast<double>(sizes.size()));
    std::nth_element(sizes.begin(), place, sizes.end());
    return *place > 0 ? *place : *std::max_element(sizes.begin(), sizes.end());
}

ErrorPicture drawErrors(const Picture& picture, const Picture& reference, double epsilon)
{
    ErrorPicture result;
    result.scale = chooseErrorScale(picture, reference, 1.0, epsilon);
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        const bool finite = isFinite(picture.radiance[i]) && isFinite(reference.radiance[i]);
        const double error = signedDifference(picture.radiance[i], reference.radiance[i], 1.0, epsilon);
        const double scaled = error == 0 ? 0.0 : error / result.scale;
        result.pixels.push_back(finite ? roundToBytes(differenceColor(scaled)) : kMagenta);
    }
    return result;
}

}  // namespace glim
