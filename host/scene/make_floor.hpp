// A floor under a scene, and a backdrop behind it.
#pragma once

#include "host/scene/load_gltf.hpp"
#include "host/scene/scene.hpp"

namespace glim {

inline constexpr const char* kFloorName = "floor";  // of its node, its mesh and its material

// A disc whose front faces up, and which from below is not there; or a square that curves up into a wall in the direction of the backdrop.
// It lies amid what the scene has, at the lowest point of it or at the height that `floor` says, and is many times as large.
Scene makeFloor(const SceneFloor& floor, const Scene& scene);

}  // namespace glim
