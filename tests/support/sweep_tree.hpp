// The tree that build_bvh approximates: every place between two centres is tried on every axis.
#pragma once

#include "host/bvh/bvh.hpp"

#include <span>

namespace glim {

// Bvh::cost of that tree, by build_bvh's rule for leaves, without a limit of depth. Recursive, O(n log^2 n) for even splits.
double computeSweepCost(std::span<const Box> boxes);

}  // namespace glim
