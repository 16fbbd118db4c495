// Reads the shapes of placed nodes: meshes, instances and spheres.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"

namespace glim {

// Fills origin, meshes, instances and spheres of `scene`, whose materials are the file's, followed by the default one. Refuses
// coordinates that do not fit float32, and a scene with nothing to draw.
void readGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, Warnings& warnings);

}  // namespace glim
