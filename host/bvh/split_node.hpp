// Splits a node's primitives between its two children.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/reference.hpp"

namespace glim {

// The first `left` references go to the left child; 0 if the node should be a leaf. `sides` are the children's bounds.
struct NodeSplit {
    std::uint32_t left = 0;
    std::array<NodeBounds, 2> sides;
};

// Reorders the references of a node that has `depth` inner nodes above it; `scratch` has room for as many. The result depends on their
// order and on nothing else.
NodeSplit splitNode(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds, std::uint32_t depth,
                    SplitRule rule, std::uint32_t leafSize);

// By the surface-area heuristic: the cheapest split has the least sum of area * primitives over both sides. Tries every split between two
// centres if there are few primitives, and otherwise those between 32 bins per axis. Returns no split (left is 0) if each leaves a side
// empty, if the node has no area, or if two primitives cost no more as one leaf.
NodeSplit splitBySah(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds);

}  // namespace glim
