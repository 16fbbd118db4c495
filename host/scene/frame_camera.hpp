// Makes a camera that sees a whole scene.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// The camera sees the whole bounding box from the front (glTF's +Z), a little from the right and above. In a picture of this aspect ratio
// (width over height) the box is in the middle, 5 % of the picture away from two opposite sides at least. The scene has at least one
// triangle or sphere.
Camera frameCamera(const Scene& scene, float aspectRatio);

}  // namespace glim
