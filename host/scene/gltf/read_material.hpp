// Reads materials and what their textures refer to.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// `index` -1 is glTF's default material. The textures' images are indices into the file's images; `name` is how messages name the material.
// Warnings say what glim ignores of it.
Material readMaterial(const GltfFile& file, int index, Warnings& warnings);

std::string materialLabel(const GltfFile& file, int index);

}  // namespace glim
