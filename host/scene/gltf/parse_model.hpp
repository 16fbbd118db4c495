// Turns checked JSON into tinygltf's model.
#pragma once

#include <tiny_gltf.h>
#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// `document` holds none of what GltfFile lists itself: buffers, images, textures, samplers, skins and animations. Throws InputError.
tinygltf::Model parseModel(const std::string& path, nlohmann::json document);

}  // namespace glim
