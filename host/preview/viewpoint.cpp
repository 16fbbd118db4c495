#include "host/preview/viewpoint.hpp"

#include "host/json.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glim {
namespace {

// Half the height of the picture at the point that the camera looks at, in metres. `height`: in pixels.
double computeHalfHeight(const Camera& camera, const Projection& projection, const Pose& pose, double height)
{
    if (camera.kind == Camera::Kind::Orthographic) {
        return static_cast<double>(camera.halfHeight);  // includes the zoom
    }
    if (projection.intrinsics) {
        return 0.5 * height / projection.intrinsics->focal.y * glm::length(pose.at - pose.from);
    }
    return std::tan(0.5 * static_cast<double>(camera.yfov)) * glm::length(pose.at - pose.from);
}

}  // namespace

void Viewpoint::enter(const Scene& scene)
{
    cameras_ = scene.cameras;
    for (Camera& camera : cameras_) {
        const bool hasAngle = camera.kind == Camera::Kind::Perspective;
        camera = applyField(camera, {fieldOf(camera).degrees, 1.0});
        if (hasAngle && projection_.intrinsics && projection_.intrinsics->center.y > 0.0) {  // for who frames the scene by it
            camera.yfov = static_cast<float>(2.0 * std::atan(projection_.intrinsics->center.y / projection_.intrinsics->focal.y));
        }
    }
    origin_ = scene.origin;
    bounds_ = computeBoundingSphere(scene);
    index_ = std::min(index_, cameras_.size() - 1);
    firstIndex_ = std::min(firstIndex_, cameras_.size() - 1);
}

Camera Viewpoint::camera(const glm::uvec2& size) const
{
    const Camera camera = placed();
    Projection projection = projection_;
    if (camera.kind == Camera::Kind::Orthographic && projection.model != Projection::Model::Equirectangular) {
        projection = Projection();
        projection.shift = projection_.shift;
    }
    return applyProjection(camera, projection, size);
}

FieldOfView Viewpoint::fieldOf(const Camera& camera) const
{
    return {camera.kind == Camera::Kind::Perspective ? field_.degrees : std::nullopt, field_.zoom};
}

Camera Viewpoint::zoomed() const { return applyField(cameras_[index_], {std::nullopt, field_.zoom}); }

// With both zooms at once, as a render has them.
Camera Viewpoint::placed() const
{
    if (!pose_) {
        return zoomed();
    }
    Pose pose = *pose_;
    pose.zoom *= field_.zoom;
    return placeCamera(cameras_[index_], pose, origin_);
}

std::optional<double> Viewpoint::fieldOfView() const
{
    const Camera seen = placed();
    const bool isChosen = seen.kind == Camera::Kind::Perspective && !projection_.intrinsics &&
                          projection_.model != Projection::Model::Fisheye && projection_.model != Projection::Model::Equirectangular;
    return isChosen ? std::optional(glm::degrees(static_cast<double>(seen.yfov))) : std::nullopt;
}

void Viewpoint::setFieldOfView(double degrees)
{
    Pose wanted = pose();
    wanted.zoom = std::tan(0.5 * static_cast<double>(zoomed().yfov)) / std::tan(0.5 * glm::radians(degrees));
    move(wanted);
}

Pose Viewpoint::pose() const
{
    const Camera& camera = cameras_[index_];
    return pose_ ? *pose_ : computePose(camera, guessDistance(camera, bounds_, origin_), origin_);
}

bool Viewpoint::choose(std::size_t index)
{
    if (index >= cameras_.size()) {
        return false;
    }
    index_ = index;
    pose_.reset();
    moved_ = true;
    return true;
}

void Viewpoint::reset() { choose(firstIndex_); }

void Viewpoint::move(const Pose& pose)
{
    pose_ = pose;
    moved_ = true;
}

void Viewpoint::follow(const Gesture& gesture, double height)
{
    const Camera seen = placed();
    switch (gesture.kind) {
    case Gesture::Kind::Orbit: move(orbit(pose(), gesture.motion, height)); break;
    case Gesture::Kind::Pan: move(pan(pose(), gesture.motion, 2.0 * computeHalfHeight(seen, projection_, pose(), height) / height)); break;
    case Gesture::Kind::Dolly: move(dolly(pose(), gesture.notches, seen.kind)); break;
    case Gesture::Kind::Click: break;
    }
}

bool Viewpoint::press(char key, double aspectRatio)
{
    switch (key) {
    case 'F': move(frame(pose(), bounds_, zoomed(), aspectRatio)); return true;
    case 'R': reset(); return true;
    case 'W':
    case 'A':
    case 'S':
    case 'D':
    case 'Q':
    case 'E': held_.insert(key); return true;
    default: return false;
    }
}

void Viewpoint::fly(Time now)
{
    const double seconds = std::min(0.1, secondsBetween(std::exchange(flown_, now), now));
    const auto axis = [this](char more, char less) { return (held_.contains(more) ? 1.0 : 0.0) - (held_.contains(less) ? 1.0 : 0.0); };
    const glm::dvec3 direction(axis('D', 'A'), axis('E', 'Q'), axis('W', 'S'));
    if (direction != glm::dvec3(0.0)) {
        move(::glim::fly(pose(), 0.5 * bounds_.radius * seconds * direction));
    }
}

std::string Viewpoint::describeAsGltf() const
{
    const Camera seen = placed();
    const glm::dvec3 from = glm::dvec3(seen.position) + origin_;
    const glm::dquat rotation = glm::quat_cast(glm::dmat3(glm::dvec3(seen.right), glm::dvec3(seen.up), -glm::dvec3(seen.forward)));
    Json camera;
    if (seen.kind == Camera::Kind::Perspective) {
        Json lens = {{"yfov", seen.yfov}, {"znear", 0.01}};
        if (seen.aspectRatio) {
            lens.set("aspectRatio", *seen.aspectRatio);
        }
        camera = {{"type", "perspective"}, {"perspective", lens}};
    } else {
        camera = {{"type", "orthographic"},
                  {"orthographic", {{"xmag", seen.halfWidth}, {"ymag", seen.halfHeight}, {"znear", 0.01}, {"zfar", 1000.0}}}};
    }
    const Json node = {{"camera", 0},
                       {"translation", Json::array({from.x, from.y, from.z})},
                       {"rotation", Json::array({rotation.x, rotation.y, rotation.z, rotation.w})}};
    return Json{{"cameras", Json::array({camera})}, {"nodes", Json::array({node})}}.dump();
}

}  // namespace glim
