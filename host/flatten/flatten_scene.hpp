// Scene and Bvh to FlatScene.
#pragma once

#include "host/bvh/bvh.hpp"
#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

namespace glim {

// The box of each primitive, triangles first, then spheres (rounded outwards): what buildBvh takes.
std::vector<Box> primitiveBoxes(const Scene& scene);

FlatScene flattenScene(const Scene& scene, const Bvh& bvh);

// `aspectRatio`: width / height of the picture. The picture's height spans the camera's vertical extent.
FlatCamera flattenCamera(const Camera& camera, float aspectRatio);

}  // namespace glim
