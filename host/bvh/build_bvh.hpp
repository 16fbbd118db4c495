// Binned surface-area-heuristic build.
#pragma once

#include "host/bvh/bvh.hpp"

#include <span>

namespace glim {

// One box per primitive, finite with lo <= hi, at least one. Deterministic: the same boxes give the same tree.
Bvh buildBvh(std::span<const Box> boxes);

}  // namespace glim
