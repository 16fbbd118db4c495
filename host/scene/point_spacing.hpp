// How far apart the points of a cloud are.
#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace glim {

// The median distance from a point to the nearest one at another place, over all points or an even sample of very many. 0 without two
// places.
double computePointSpacing(std::vector<glm::dvec3> points);

}  // namespace glim
