#include "host/preview/controls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glim {
namespace {

constexpr double kPole = 0.002;      // radians that a camera stays away from straight up and down
constexpr double kNotch = 0.9;       // of the distance that is left after one
constexpr double kNearest = 1e-7;    // of the distance to the origin: nearer, `from` and `at` would round to one point

struct Axes {
    glm::dvec3 right, up, forward;
};

Axes axesOf(const Pose& pose)
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
    Pose turned = pose;
    turned.from = pose.at + back;
    return turned;
}

Pose pan(const Pose& pose, const glm::dvec2& motion, double pixel)
{
    const Axes axes = axesOf(pose);
    const glm::dvec3 way = pixel * (motion.y * axes.up - motion.x * axes.right);
    Pose moved = pose;
    moved.from += way;
    moved.at += way;
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
    const double nearest = kNearest * std::max(glm::length(pose.at), glm::length(pose.from));
    const double distance = std::max(nearest, factor * glm::length(back));
    moved.from = pose.at + distance * glm::normalize(back);
    return moved;
}

Pose fly(const Pose& pose, const glm::dvec3& way)
{
    const Axes axes = axesOf(pose);
    const glm::dvec3 step = way.x * axes.right + way.y * axes.up + way.z * axes.forward;
    Pose moved = pose;
    moved.from += step;
    moved.at += step;
    return moved;
}

Pose frame(const Pose& pose, const Bounds& bounds, const Camera& camera, double aspectRatio)
{
    const double narrower = std::min(1.0, aspectRatio);
    const double slope = std::tan(0.5 * static_cast<double>(camera.yfov)) * narrower;
    const bool orthographic = camera.kind == Camera::Kind::Orthographic;
    Pose moved = pose;
    moved.zoom = orthographic ? static_cast<double>(camera.halfHeight) * narrower / bounds.radius : 1.0;
    const double distance = orthographic ? 2.0 * bounds.radius : bounds.radius / std::sin(std::atan(slope));
    moved.at = bounds.center;
    moved.from = bounds.center - distance * axesOf(pose).forward;
    return moved;
}

Bounds computeBounds(const Scene& scene)
{
    const double infinity = std::numeric_limits<double>::infinity();
    glm::dvec3 low(infinity), high(-infinity);
    for (const Triangle& triangle : scene.triangles) {
        for (const glm::vec3& vertex : triangle.vertices) {
            low = glm::min(low, glm::dvec3(vertex));
            high = glm::max(high, glm::dvec3(vertex));
        }
    }
    for (const Sphere& sphere : scene.spheres) {
        low = glm::min(low, glm::dvec3(sphere.center - sphere.radius));
        high = glm::max(high, glm::dvec3(sphere.center + sphere.radius));
    }
    const double radius = 0.5 * glm::length(high - low);
    return {0.5 * (low + high) + scene.origin, radius > 0.0 ? radius : 1.0};
}

double guessDistance(const Camera& camera, const Bounds& bounds, const glm::dvec3& sceneOrigin)
{
    const glm::dvec3 there = bounds.center - sceneOrigin - glm::dvec3(camera.position);
    return std::max(glm::dot(there, glm::dvec3(camera.forward)), 0.05 * bounds.radius);
}

}  // namespace glim
