// The media in which rays begin: a camera or a light may lie in a solid, or in several nested solids.
#pragma once

#include "host/flatten/flat_scene.hpp"

namespace glim {

// The camera with the media of its rays (FlatCamera::media). While something moves they may vary.
FlatCamera placeInMedia(FlatCamera camera, const FlatScene& flat);

// Whether a light may lie in a solid. False if no surface of a solid touches the box around all lights, and the middle of that box lies in
// no solid. Light paths look for the media that they begin in only if it is true.
bool mayLightsBeInMedia(const FlatScene& flat);

}  // namespace glim
