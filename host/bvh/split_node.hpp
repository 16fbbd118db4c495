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

}  // namespace glim
