// Reads lights, environments and cameras.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"
#include "host/scene/gltf/read_images.hpp"

#include <optional>

namespace glim {

// Appends the lights (KHR_lights_punctual) and cameras of `nodes` to `scene`, relative to its origin.
void readLightsAndCameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, Warnings& warnings);

// The light of a scene of the file, if it has one (EXT_lights_image_based): level 0 of its specular images, the six faces of a cube, as a
// latitude-longitude map. Their prefiltered levels and the irradiance are for renderers that do not trace rays. Throws InputError if a face
// is missing or broken.
std::optional<Environment> readImageLight(const GltfFile& file, std::size_t sceneOfFile, DecodedParts& decoded, Scene& scene,
                                          Warnings& warnings);

}  // namespace glim
