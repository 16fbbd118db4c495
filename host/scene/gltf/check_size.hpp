// Asks whether a scene fits into memory before any of it is read.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"

namespace glim {

// By the counts of accessors alone. Refuses a scene that needs more memory than the machine has, or than the process may take.
void checkSize(const GltfFile& file, const std::vector<PlacedNode>& nodes);

}  // namespace glim
