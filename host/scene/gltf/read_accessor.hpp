// Reads accessors of every kind (dense, interleaved, sparse, normalised) into plain arrays.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <glm/glm.hpp>

#include <cstdint>

namespace glim {

// `use` says what the accessor is for in messages: "POSITION of meshes[0].primitives[1]".
// Value is glm::dvec3, glm::vec2 or glm::vec4; a vec4 may also come from VEC3, then with w = 1. Values may be NaN or infinite.
template <class Value>
std::vector<Value> readVectors(const GltfFile& file, std::size_t accessor, const std::string& use);

std::vector<std::uint32_t> readIndices(const GltfFile& file, std::size_t accessor, const std::string& use);

}  // namespace glim
