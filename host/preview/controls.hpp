// How what the hand does moves a camera. Pure functions; distances in metres.
#pragma once

#include "host/scene/pose.hpp"

namespace glim {

// `motion` of the mouse in pixels of a picture `height` pixels high: the camera goes round what it looks at, half a turn for the
// picture's height, and never over the poles.
Pose orbit(const Pose& pose, const glm::dvec2& motion, double height);

// What the camera looks at follows the mouse. `pixel`: the width of a pixel of the picture there, metres.
Pose pan(const Pose& pose, const glm::dvec2& motion, double pixel);

// Nearer by a tenth of the distance for each notch; an orthographic camera shows things larger instead.
Pose dolly(const Pose& pose, double notches, Camera::Kind kind);

// By `way` metres to the right, up and ahead.
Pose fly(const Pose& pose, const glm::dvec3& way);

// The sphere around everything in the scene, world coordinates.
struct Bounds {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};

// Sees all of the sphere, from the direction it now looks from, in a picture of this width over height.
Pose frame(const Pose& pose, const Bounds& bounds, const Camera& camera, double aspectRatio);

Bounds computeBounds(const Scene& scene);

// How far ahead of a camera of the file is what it is likely about: the middle of the scene, as far as it is in front.
double guessDistance(const Camera& camera, const Bounds& bounds, const glm::dvec3& sceneOrigin);

}  // namespace glim
