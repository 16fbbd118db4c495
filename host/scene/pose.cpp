#include "host/scene/pose.hpp"

#include "host/error.hpp"
#include "host/text.hpp"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

void magnify(Camera& camera, double zoom)
{
    if (zoom != 1.0) {  // at 1 no bit may change
        camera.yfov = static_cast<float>(2.0 * std::atan(std::tan(0.5 * static_cast<double>(camera.yfov)) / zoom));
        if (camera.kind == Camera::Kind::Perspective && static_cast<double>(camera.yfov) >= std::numbers::pi) {
            throw InputError(MessageId::OutOfRange, {part::place("--zoom"), ": ", part::value(exactText(zoom)),
                                                     ": the camera would see 180 degrees; expected ", part::expected("more"), "."});
        }
    }
    camera.halfWidth = static_cast<float>(static_cast<double>(camera.halfWidth) / zoom);
    camera.halfHeight = static_cast<float>(static_cast<double>(camera.halfHeight) / zoom);
}

}  // namespace

Camera applyField(const Camera& camera, const FieldOfView& field)
{
    Camera changed = camera;
    if (field.degrees) {
        if (camera.kind == Camera::Kind::Orthographic) {
            throw InputError(MessageId::Conflict, {part::place("--fov"), ": camera ", part::quoted(camera.name),
                                                   " is orthographic; expected ", part::expected("--zoom"), " instead."});
        }
        changed.yfov = static_cast<float>(glm::radians(*field.degrees));
    }
    magnify(changed, field.zoom);
    return changed;
}

Camera placeCamera(const Camera& camera, const Pose& pose, const glm::dvec3& sceneOrigin)
{
    const glm::dvec3 ahead = pose.at - pose.from;
    const glm::dvec3 across = glm::cross(ahead, pose.up);
    if (!(glm::length(ahead) > 0.0)) {
        throw InputError(MessageId::Degenerate,
                         {part::place("--look-at"), ": is where --look-from is; expected ", part::expected("another point"), "."});
    }
    if (!(glm::length(across) > 1e-9 * glm::length(ahead) * glm::length(pose.up))) {
        throw InputError(MessageId::Degenerate, {part::place("--look-up"), ": expected ",
                                                 part::expected("a direction other than the one that the camera looks in"), "."});
    }
    const glm::dvec3 forward = glm::normalize(ahead), right = glm::normalize(across);
    Camera placed = camera;
    placed.position = glm::vec3(pose.from - sceneOrigin);
    placed.forward = glm::vec3(forward);
    placed.right = glm::vec3(right);
    placed.up = glm::vec3(glm::cross(right, forward));
    placed.motion = nullptr;
    magnify(placed, pose.zoom);
    return placed;
}

Camera applyProjection(const Camera& camera, const Projection& projection, const glm::uvec2& size)
{
    using Model = Projection::Model;
    const bool isFisheye = projection.model == Model::Fisheye;
    if ((projection.intrinsics || isFisheye || projection.model == Model::RadialTangential) && camera.kind == Camera::Kind::Orthographic) {
        const char* const option = projection.intrinsics ? "--intrinsics" : isFisheye ? "--fisheye" : "--distortion";
        throw InputError(MessageId::Conflict, {part::place(option), ": camera ", part::quoted(camera.name), " is orthographic; expected ",
                                               part::expected("a perspective camera"), "."});
    }
    Camera changed = camera;
    changed.projection = projection;
    if (projection.intrinsics) {
        changed.projection.intrinsics->size = glm::dvec2(size);
    }
    if (std::optional<Crop>& crop = changed.projection.crop) {
        const glm::uvec2 end = crop->corner + crop->size;
        if (end.x > size.x || end.y > size.y) {
            throw InputError(MessageId::OutOfRange,
                             {part::place("--crop"), ": ends at column ", part::value(std::to_string(end.x)), " and row ",
                              part::value(std::to_string(end.y)), ", expected a part of the picture of ",
                              part::expected(std::to_string(size.x) + "x" + std::to_string(size.y)), "."});
        }
        crop->whole = size;
    }
    return changed;
}

std::optional<Pose> computeRigidPose(const glm::dmat4& worldFromCamera, const glm::dvec3& toGltf)
{
    constexpr double kMatrixRounding = 1e-4;  // of matrices that were float32, or printed with few digits
    const glm::dmat3 axes(worldFromCamera[0] * toGltf.x, worldFromCamera[1] * toGltf.y, worldFromCamera[2] * toGltf.z);
    const glm::dmat3 off = glm::transpose(axes) * axes - glm::dmat3(1.0);
    const glm::dvec4 row = glm::row(worldFromCamera, 3) - glm::dvec4(0.0, 0.0, 0.0, 1.0);
    const double most = std::max({glm::length(off[0]), glm::length(off[1]), glm::length(off[2]), glm::length(row)});
    if (!(most <= kMatrixRounding) || !(glm::determinant(axes) > 0.0)) {
        return std::nullopt;
    }
    Pose pose;
    pose.from = glm::dvec3(worldFromCamera[3]);
    pose.at = pose.from - axes[2];
    pose.up = axes[1] + 0.0;  // no -0 in a film's settings
    return pose;
}

Pose computePose(const Camera& camera, double distance, const glm::dvec3& sceneOrigin)
{
    constexpr double kLevel = 1e-3;  // radians of roll that still count as level
    const glm::dvec3 right(camera.right), up(camera.up), forward(camera.forward);
    const bool level = std::abs(right.y) < kLevel && up.y > kLevel;
    Pose pose;
    pose.from = glm::dvec3(camera.position) + sceneOrigin;
    pose.at = pose.from + distance * forward;
    pose.up = level ? glm::dvec3(0.0, 1.0, 0.0) : up;
    return pose;
}

}  // namespace glim
