// Where a camera stands and looks.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// In the file's world coordinates, metres.
struct Pose {
    glm::dvec3 from{0.0, 0.0, 1.0};
    glm::dvec3 at{0.0};             // the point in the middle of the picture
    glm::dvec3 up{0.0, 1.0, 0.0};   // shows upwards in the picture; need not be perpendicular or of unit length
    double zoom = 1.0;              // what stood in the picture stands this much larger in it
};

// `camera`, standing and looking elsewhere. Throws InputError if the pose gives no direction to look or to hold upright.
Camera placeCamera(const Camera& camera, const Pose& pose, const glm::dvec3& sceneOrigin);

// The pose in which `camera` stands, looking at what is `distance` metres ahead. Upwards is +Y if the camera is level, so that
// turning it keeps it level.
Pose poseOf(const Camera& camera, double distance, const glm::dvec3& sceneOrigin);

}  // namespace glim
