// The measure that build and check share: a random line that meets a box meets a box inside it with probability equal to
// the ratio of their areas.
#pragma once

#include "host/bvh/bvh.hpp"

#include <span>

namespace glim {

// Half of a box's surface, dx dy + dy dz + dz dx. In double: the squares of float extents overflow a float.
double computeHalfArea(const Box& box);

// Expected steps of a line that meets the root: 1 per inner node plus 1 per primitive of a leaf, weighted by area.
// Under a root without area (all primitives on one axis-parallel line) every node counts as met.
double computeCost(std::span<const BvhNode> nodes);

}  // namespace glim
