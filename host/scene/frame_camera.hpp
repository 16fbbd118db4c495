// Makes a camera for a scene that has none.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// The camera sees the whole bounding box from the front (glTF's +Z), a little from the right and above, in a picture of this aspect ratio
// (width over height). The scene has at least one triangle or sphere.
Camera frameCamera(const Scene& scene, float aspectRatio);

}  // namespace glim
