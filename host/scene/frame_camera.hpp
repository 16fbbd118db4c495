// Makes cameras that see a whole scene.
#pragma once

#include "host/scene/pose.hpp"

namespace glim {

// The camera sees the whole bounding box from the front (glTF's +Z), a little from the right and above. In a picture of this aspect ratio
// (width over height) the box is in the middle, 5 % of the picture away from two opposite sides at least. The scene has at least one
// triangle or sphere.
Camera frameCamera(const Scene& scene, float aspectRatio, float yfov = Camera().yfov);

// `count` poses of that camera on a circle about the vertical axis of the box, the first from the same side, the others counter-clockwise
// seen from above. All are at one distance, from which the scene has these margins in all of them together.
std::vector<Pose> frameTurntable(const Scene& scene, float aspectRatio, std::uint32_t count, float yfov = Camera().yfov);

}  // namespace glim
