// The surface-area heuristic: cheapest is the split with the least sum over both sides of area * primitives.
#pragma once

#include "host/bvh/divide_node.hpp"

namespace glim {

// Tries every place between two centres of few primitives, and 32 places on each axis of more. Without a split (left is 0) if
// none has primitives on both sides, if the node has no area, or if it has two primitives that are as cheap together.
Division divideBySah(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds);

}  // namespace glim
