// Decodes the images that a scene's materials use.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// Throws InputError that names the image and says what is wrong. Notes the image's file, if it has one, among scene.files.
DecodedImage readImage(const GltfFile& file, std::size_t image, Scene& scene);

// Fills scene.images with those that the materials use (used[i]: material i is used) and makes the textures refer to them; unused materials
// lose their textures. Each image is there once, unless it is scaled down and used both for colours and for numbers. A missing or broken
// image is refused, or replaced by a grey one if the options say so.
void readImages(const GltfFile& file, const LoadOptions& options, const std::vector<bool>& used, Scene& scene, Warnings& warnings);

}  // namespace glim
