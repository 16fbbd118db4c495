// Replaces compressed geometry by plain buffers, views and accessors, so that no later reader knows of compression.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// More bytes or elements than this for each compressed byte are refused before memory is asked for them. The bitstreams of meshopt cannot
// reach more than 64 (the first one) or 1024 (the second, where two bits can stand for 256 bytes).
constexpr std::uint64_t kMaxCompression = 1024;

// EXT_meshopt_compression and KHR_meshopt_compression. What a fallback holds is not read.
void decompressViews(const std::string& path, nlohmann::json& document, Buffers& buffers);

// KHR_draco_mesh_compression. Each primitive gets accessors of its own, also where the file has uncompressed ones beside it.
void decompressPrimitives(const std::string& path, nlohmann::json& document, Buffers& buffers);

}  // namespace glim
