// The cost measure that builder and checker share. A random line that hits a box also hits a box inside it with a probability equal to
// the ratio of their surface areas.
#pragma once

#include "host/bvh/bvh.hpp"

#include <span>

namespace glim {

// Half of a box's surface area, dx dy + dy dz + dz dx. In double, because squares of float extents overflow a float.
double computeHalfArea(const Box& box);

// Expected steps of a line that meets the root: 1 per inner node plus 1 per primitive of a leaf, weighted by area. If the root has no area
// (all primitives are on one axis-parallel line), every node counts as met.
double computeCost(std::span<const BvhNode> nodes);

}  // namespace glim
