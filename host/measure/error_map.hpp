// Where the estimated error of a picture is.
#pragma once

#include "host/measure/picture.hpp"

#include <vector>

namespace glim {

// Each pixel's estimated squared error, relative to radiance that is `likely`: the mean of these is estimateErrors()'s relMSE.
// kUnknownError (shaders/shared/display_colors.h) where the variance is not known; NaN where the pixel is not finite.
std::vector<float> mapErrors(const Picture& picture, const std::vector<glm::dvec3>& likely);

}  // namespace glim
