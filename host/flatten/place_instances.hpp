// Instances of shared meshes as the kernels need them: transforms in float32, with bounds on their rounding errors.
#pragma once

#include "host/bvh/bvh.hpp"
#include "host/flatten/primitives.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <span>

namespace glim {

// Rows of the transform from the scene's space to the mesh's.
std::array<glm::vec4, 3> meshFromScene(const Placement& placement);

// Without references and primitive ids. `meshBox`: of the shared mesh.
InstanceData placeInstance(const Placement& placement, const Box& meshBox);

// Holds the boxes `parts` of the mesh's space as the placement places them, at any time.
Box placeBoxes(const Placement& placement, std::span<const Box> parts);

// How far a ray of the scene, as the kernels transform it, may pass beside its place, per axis. `farthest`: the greatest coordinates of
// the scene.
glm::vec3 boundRayError(const Placement& placement, const glm::vec3& farthest);

}  // namespace glim
