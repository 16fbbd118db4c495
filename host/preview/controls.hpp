// Camera moves, as pure functions. Distances are in metres.
#pragma once

#include "host/scene/pose.hpp"

namespace glim {

// Moves the camera around the point that it looks at, but never over the poles. `motion` is that of the mouse in pixels; the height
// of the picture, in pixels, makes half a turn.
Pose orbit(const Pose& pose, const glm::dvec2& motion, double height);

// Moves the camera so that the point it looks at follows the mouse. `pixel` is the width of a pixel at that point, in metres.
Pose pan(const Pose& pose, const glm::dvec2& motion, double pixel);

// Moves the camera a tenth of the distance nearer for each notch of the wheel. An orthographic camera zooms instead.
Pose dolly(const Pose& pose, double notches, Camera::Kind kind);

// Moves the camera and the point that it looks at by `offset` metres to the right, up and ahead.
Pose fly(const Pose& pose, const glm::dvec3& offset);

// A sphere around the whole scene, in world coordinates.
struct BoundingSphere {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};

// Places the camera so that it sees the whole sphere. It keeps its direction. `aspectRatio` is the picture's width over its height.
Pose frame(const Pose& pose, const BoundingSphere& bounds, const Camera& camera, double aspectRatio);

BoundingSphere computeBoundingSphere(const Scene& scene);

// The likely distance of what a camera of the file looks at: that of the scene's centre along the view direction.
double guessDistance(const Camera& camera, const BoundingSphere& bounds, const glm::dvec3& sceneOrigin);

}  // namespace glim
