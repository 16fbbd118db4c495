// Where a camera's film shows what is in a direction: the inverse of the rays of shaders/lib/camera.glsl, in double.
#pragma once

#include "host/flatten/flat_scene.hpp"

#include <optional>

namespace glim {

// `from`: from the camera to a place; or, but for orthographic cameras, a direction of any length. The lens is a pinhole. The film is
// [-1, 1]^2 with +y up; a place may be shown beside it. Nothing if none shows it: behind the camera, or where a lens folds back.
std::optional<glm::dvec2> projectToFilm(const FlatCamera& camera, const glm::dvec3& from);

}  // namespace glim
