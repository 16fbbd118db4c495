// Accessors of every kind (dense, interleaved, sparse, normalised) to plain arrays.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <glm/glm.hpp>

#include <cstdint>

namespace glim {

// `use` says what the accessor is for in messages: "POSITION of meshes[0].primitives[1]".
// Values may be NaN or infinite.
std::vector<glm::dvec3> readVec3(const GltfFile& file, std::size_t accessor, const std::string& use);

std::vector<std::uint32_t> readIndices(const GltfFile& file, std::size_t accessor, const std::string& use);

}  // namespace glim
