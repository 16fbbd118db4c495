// Rec.709.
#pragma once

#include <glm/glm.hpp>

namespace glim {

inline double luminanceOf(const glm::dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

}  // namespace glim
