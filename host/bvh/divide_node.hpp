// One node's primitives into those of its two children.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/reference.hpp"

namespace glim {

// The first `left` references go left; 0 if the node is better a leaf. `sides` are the children's bounds.
struct Division {
    std::uint32_t left = 0;
    std::array<NodeBounds, 2> sides;
};

// Reorders the references, of a node with `depth` inner nodes above it; `scratch` has as many. What comes of it depends on their
// order, and on nothing else.
Division divideNode(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds, std::uint32_t depth,
                    SplitRule rule);

}  // namespace glim
