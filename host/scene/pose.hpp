// Poses of cameras: where they stand and look.
#pragma once

#include "host/scene/scene.hpp"

#include <optional>

namespace glim {

// In the file's world coordinates, metres.
struct Pose {
    glm::dvec3 from{0.0, 0.0, 1.0};
    glm::dvec3 at{0.0};            // the point in the middle of the picture
    glm::dvec3 up{0.0, 1.0, 0.0};  // points upwards in the picture; need not be perpendicular or of unit length
    double zoom = 1.0;             // magnification in the picture
};

// How much a camera sees from where it is.
struct FieldOfView {
    std::optional<double> degrees;  // vertical, of a perspective camera; absent: the camera's own
    double zoom = 1.0;              // magnification in the picture, of this angle
};

// Throws InputError if there is an angle for an orthographic camera, or if the zoom opens the angle to 180 degrees.
Camera applyField(const Camera& camera, const FieldOfView& field);

// Returns `camera` in another pose. Throws InputError if the pose defines no view direction, or no up direction.
Camera placeCamera(const Camera& camera, const Pose& pose, const glm::dvec3& sceneOrigin);

// Returns the camera with that projection, in a picture of that size. Throws InputError if an orthographic camera is to have intrinsics or
// a lens that distorts, or if the crop is not within the picture.
Camera applyProjection(const Camera& camera, const Projection& projection, const glm::uvec2& size);

// The pose of a camera at `worldFromCamera`, whose axes times `toGltf` are those of glTF: x right, y up, z backwards. Nothing if the matrix
// is no rotation and translation.
std::optional<Pose> computeRigidPose(const glm::dmat4& worldFromCamera, const glm::dvec3& toGltf);

// Returns the pose of `camera`, which looks at the point `distance` metres ahead. Up is +Y if the camera is level, so that it stays level
// when it is turned.
Pose computePose(const Camera& camera, double distance, const glm::dvec3& sceneOrigin);

}  // namespace glim
