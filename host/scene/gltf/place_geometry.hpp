// Meshes and spheres of the placed nodes into a Scene, recentred.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"

namespace glim {

// Fills origin, triangles, normals, primitives and spheres of `scene`, whose materials must be the file's, then the
// default one.
void placeGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace glim
