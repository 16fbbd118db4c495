#include "host/preview/viewpoint.hpp"

#include "host/json.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace glim {

void Viewpoint::enter(const Scene& scene)
{
    cameras_ = scene.cameras;
    origin_ = scene.origin;
    bounds_ = computeBounds(scene);
    index_ = std::min(index_, cameras_.size() - 1);
    firstIndex_ = std::min(firstIndex_, cameras_.size() - 1);
}

Camera Viewpoint::camera() const { return pose_ ? placeCamera(cameras_[index_], *pose_, origin_) : cameras_[index_]; }

Pose Viewpoint::pose() const
{
    const Camera& camera = cameras_[index_];
    return pose_ ? *pose_ : poseOf(camera, guessDistance(camera, bounds_, origin_), origin_);
}

bool Viewpoint::choose(std::size_t index)
{
    if (index >= cameras_.size()) {
        return false;
    }
    index_ = index;
    pose_.reset();
    return true;
}

void Viewpoint::reset()
{
    index_ = firstIndex_;
    pose_.reset();
}

std::string Viewpoint::describeAsGltf() const
{
    const Camera seen = camera();
    const glm::dvec3 from = glm::dvec3(seen.position) + origin_;
    const glm::dquat turn = glm::quat_cast(glm::dmat3(glm::dvec3(seen.right), glm::dvec3(seen.up), -glm::dvec3(seen.forward)));
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
    const Json node = {
        {"camera", 0}, {"translation", Json::array({from.x, from.y, from.z})}, {"rotation", Json::array({turn.x, turn.y, turn.z, turn.w})}};
    return Json{{"cameras", Json::array({camera})}, {"nodes", Json::array({node})}}.dump();
}

}  // namespace glim
