// A camera for scenes that bring none.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// Sees the whole bounding box, from the front (glTF's +Z), a little from the right and above, in a picture of this aspect
// ratio (width over height). Expects at least one triangle or sphere.
Camera frameCamera(const Scene& scene, float aspectRatio);

}  // namespace glim
