// Reads the lights (KHR_lights_punctual) and cameras of placed nodes.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"

namespace glim {

// Appends the lights and cameras of `nodes` to `scene`, relative to its origin.
void readLightsAndCameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, Warnings& warnings);

}  // namespace glim
