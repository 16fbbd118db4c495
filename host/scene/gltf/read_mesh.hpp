// Reads meshes. What glTF calls a primitive of a mesh is a mesh here.
#pragma once

#include "host/scene/gltf/pose_mesh.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// Each mesh is named after the file's mesh, with a number if that has several primitives. The default material's index follows the file's
// last one. Points, lines and primitives without positions are left out, each with a warning.
std::vector<Mesh> readMeshes(const GltfFile& file, std::size_t mesh, const MeshPose& pose, Warnings& warnings);

}  // namespace glim
