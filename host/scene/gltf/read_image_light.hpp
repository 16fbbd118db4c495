// EXT_lights_image_based: the six faces of a cube to a latitude-longitude map.
#pragma once

#include "host/scene/gltf/read_images.hpp"

#include <optional>

namespace glim {

// The light of a scene of the file, if it has one: level 0 of its specular images. Their prefiltered levels and the irradiance are for
// renderers that do not trace rays. Throws InputError if a face is missing or broken.
std::optional<Environment> readImageLight(const GltfFile& file, std::size_t sceneOfFile, DecodedParts& decoded, Scene& scene,
                                          Warnings& warnings);

}  // namespace glim
