// EXT_mesh_gpu_instancing.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"

namespace glim {

// How many instances of its mesh the node has, without reading them.
std::uint64_t countInstances(const GltfFile& file, std::size_t node);

// The same where no attribute has a bufferView, else 0.
std::uint64_t countUnbackedInstances(const GltfFile& file, std::size_t node);

// Where the node's instances stand, in the node's own space: one identity without the extension. Refuses attributes of different counts and
// values that are not finite.
std::vector<glm::dmat4> readInstanceTransforms(const GltfFile& file, std::size_t node);

}  // namespace glim
