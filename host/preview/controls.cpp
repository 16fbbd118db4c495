#include "host/preview/controls.hpp"

#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glim {
namespace {

constexpr double kPole = 0.002;    // radians: the least angle between the view direction and the vertical
constexpr double kNotch = 0.9;     // the share of the distance that is left after a notch of the wheel
constexpr double kClosest = 1e-7;  // relative to the distance from the origin: below it `from` and `at` might round to one point

struct Axes {
    glm::dvec3 right, up, forward;
};

Axes computeAxes(const Pose& pose)
{
    const glm::dvec3 forward = glm::normalize(pose.at - pose.from);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, pose.up));
    return {right, glm::cross(right, forward), forward};
}

glm::dvec3 rotate(const glm::dvec3& v, const glm::dvec3& axis, double angle)
{
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) + axis * (glm::dot(axis, v) * (1.0 - std::cos(angle)));
}

}  // namespace

Pose orbit(const Pose& pose, const glm::dvec2& motion, double height)
{
    const double perPixel = std::numbers::pi / height;
    const glm::dvec3 up = glm::normalize(pose.up);
    glm::dvec3 back = rotate(pose.from - pose.at, up, -motion.x * perPixel);
    const double polar = std::acos(std::clamp(glm::dot(glm::normalize(back), up), -1.0, 1.0));
    const double wanted = std::clamp(polar - motion.y * perPixel, kPole, std::numbers::pi - kPole);
    back = rotate(back, glm::normalize(glm::cross(up, back)), wanted - polar);
    Pose orbited = pose;
    orbited.from = pose.at + back;
    return orbited;
}

Pose pan(const Pose& pose, const glm::dvec2& motion, double pixel)
{
    const Axes axes = computeAxes(pose);
    const glm::dvec3 offset = pixel * (motion.y * axes.up - motion.x * axes.right);
    Pose moved = pose;
    moved.from += offset;
    moved.at += offset;
    return moved;
}

Pose dolly(const Pose& pose, double notches, Camera::Kind kind)
{
    Pose moved = pose;
    const double factor = std::pow(kNotch, std::clamp(notches, -100.0, 100.0));
    if (kind == Camera::Kind::Orthographic) {
        moved.zoom = std::clamp(pose.zoom / factor, 1e-6, 1e6);
        return moved;
    }
    const glm::dvec3 back = pose.from - pose.at;
    const double nearest = kClosest * std::max(glm::length(pose.at), glm::length(pose.from));
    const double distance = std::max(nearest, factor * glm::length(back));
    moved.from = pose.at + distance * glm::normalize(back);
    return moved;
}

Pose fly(const Pose& pose, const glm::dvec3& offset)
{
    const Axes axes = computeAxes(pose);
    const glm::dvec3 step = offset.x * axes.right + offset.y * axes.up + offset.z * axes.forward;
    Pose moved = pose;
    moved.from += step;
    moved.at += step;
    return moved;
}

Pose frame(const Pose& pose, const BoundingSphere& bounds, const Camera& camera, double aspectRatio)
{
    const double narrower = std::min(1.0, aspectRatio);
    const double slope = std::tan(0.5 * static_cast<double>(camera.yfov)) / pose.zoom * narrower;
    const bool orthographic = camera.kind == Camera::Kind::Orthographic;
    Pose moved = pose;
    moved.zoom = orthographic ? std::abs(static_cast<double>(camera.halfHeight)) * narrower / bounds.radius : pose.zoom;
    const double distance = orthographic ? 2.0 * bounds.radius : bounds.radius / std::sin(std::atan(slope));
    moved.at = bounds.center;
    moved.from = bounds.center - distance * computeAxes(pose).forward;
    return moved;
}

BoundingSphere computeBoundingSphere(const Scene& scene)
{
    const WorldBox box = computeWorldBox(scene);
    const glm::dvec3 low(box.low), high(box.high);
    const double radius = 0.5 * glm::length(high - low);
    return {0.5 * (low + high) + scene.origin, radius > 0.0 ? radius : 1.0};
}

double guessDistance(const Camera& camera, const BoundingSphere& bounds, const glm::dvec3& sceneOrigin)
{
    const glm::dvec3 toCenter = bounds.center - sceneOrigin - glm::dvec3(camera.position);
    return std::max(glm::dot(toCenter, glm::dvec3(camera.forward)), 0.05 * bounds.radius);
}

}  // namespace glim
