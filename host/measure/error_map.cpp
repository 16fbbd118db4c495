#include "host/measure/error_map.hpp"

#include "host/measure/compare_images.hpp"
#include "shaders/shared/display_colors.h"

#include <cmath>
#include <limits>

namespace glim {

std::vector<float> mapErrors(const Picture& picture, const std::vector<glm::dvec3>& likely)
{
    const double epsilon = relativeEpsilon(picture);
    std::vector<float> errors;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        const glm::dvec3 variance(picture.variance[i]), terms = variance / (likely[i] * likely[i] + epsilon);
        const double sum = terms.x + terms.y + terms.z;
        if (!isFinite(picture.radiance[i])) {
            errors.push_back(std::numeric_limits<float>::quiet_NaN());
        } else {
            errors.push_back(static_cast<float>(std::isnan(sum) ? kUnknownError : sum / 3.0));
        }
    }
    return errors;
}

}  // namespace glim
