// Splits a node by the surface-area heuristic: the cheapest split has the least sum of area * primitives over both sides.
#pragma once

#include "host/bvh/split_node.hpp"

namespace glim {

// Tries every split between two centres if there are few primitives, and otherwise those between 32 bins per axis. Returns no split (left
// is 0) if each leaves a side empty, if the node has no area, or if two primitives cost no more as one leaf.
NodeSplit splitBySah(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds);

}  // namespace glim
