// Packs a wide tree into the texels that kernels read (shaders/shared/scene_types.h).
#pragma once

#include "host/bvh/wide_bvh.hpp"
#include "shaders/shared/scene_types.h"

namespace glim {

// Returns kNodeTexels texels for each node, in the tree's order. Their boxes contain the tree's boxes.
std::vector<uvec4> packNodes(const WideBvh& bvh);

}  // namespace glim
