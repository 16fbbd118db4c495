// Decodes the images that a scene's materials use.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// Fills scene.images with those that the materials use (used[i]: material i is used), each once, and makes the textures refer to them;
// unused materials lose their textures. A missing or broken image is refused, or replaced by a grey one if the options say so.
void readImages(const GltfFile& file, const LoadOptions& options, const std::vector<bool>& used, Scene& scene, Warnings& warnings);

}  // namespace glim
