#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <optional>
#include <span>

namespace glim {

// The tree with the boxes of primitives that have moved, by id; instances follow them. Trees of shared meshes stay as they are.
// Returns nothing if its cost would be more than `maxCost` times that of the tree as it was built, which `bvh.cost` remains.
std::optional<WideBvh> refitBvh(WideBvh bvh, std::span<const Box> boxes, double maxCost);

}  // namespace glim
