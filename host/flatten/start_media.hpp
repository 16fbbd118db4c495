// The media that rays are in where they begin: a camera or a lamp may lie in a solid, or in several that contain each other.
#pragma once

#include "host/flatten/flat_scene.hpp"

namespace glim {

// The camera with the media of its rays (FlatCamera::media).
FlatCamera placeInMedia(FlatCamera camera, const FlatScene& flat);

// Whether the box around all lamps meets that around all solids of a medium: then light paths have to look for the media that they begin
// in.
bool mayLampsBeInMedia(const FlatScene& flat);

}  // namespace glim
