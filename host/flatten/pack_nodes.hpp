// From a wide tree to the texels that kernels read (shaders/shared/scene_types.h).
#pragma once

#include "host/bvh/wide_bvh.hpp"
#include "shaders/shared/scene_types.h"

namespace glim {

// kNodeTexels for each node, in the order of the tree's. The boxes in them contain those of the tree.
std::vector<uvec4> packNodes(const WideBvh& bvh);

}  // namespace glim
