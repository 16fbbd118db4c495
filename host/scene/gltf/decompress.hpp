// Replaces compressed geometry by plain buffers, views and accessors, so that no later reader knows of compression.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// EXT_meshopt_compression and KHR_meshopt_compression. What a fallback holds is not read. `ownBytes`: how many the file has.
void decompressViews(const std::string& path, nlohmann::json& document, std::uint64_t ownBytes, Buffers& buffers);

// KHR_draco_mesh_compression. Each primitive gets accessors of its own, also where the file has uncompressed ones beside it.
void decompressPrimitives(const std::string& path, nlohmann::json& document, std::uint64_t ownBytes, Buffers& buffers);

}  // namespace glim
