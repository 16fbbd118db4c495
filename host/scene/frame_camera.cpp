#include "host/scene/frame_camera.hpp"

#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

// What stays free on each side of the picture, as a share of it.
constexpr double kMargin = 0.05;

// The corners of a shape as a camera sees them from far away along one axis of its picture: how far aside, and how much nearer than the
// shape's centre.
struct Corner {
    double lateral, nearer;
};

using FrameCorners = std::vector<Corner>;

// Where the camera stands on that axis, if corners at the least and the greatest slope against the view direction are to be as steep as
// each other: `lateral`. `distance` of the camera from the centre: where this slope is `slope`.
struct Place {
    double lateral, distance;
};

Place fit(const FrameCorners& corners, double slope)
{
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (const Corner& corner : corners) {
        high = std::max(high, corner.lateral + slope * corner.nearer);
        low = std::min(low, corner.lateral - slope * corner.nearer);
    }
    return {0.5 * (high + low), 0.5 * (high - low) / slope};
}

// Where the shape's picture is in the middle for a camera at `distance`, which is at least that of fit(corners, slope).
double centered(const FrameCorners& corners, double slope, double distance)
{
    double flat = 0.0, steep = slope;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (flat + steep);
        (fit(corners, middle).distance > distance ? flat : steep) = middle;
    }
    return fit(corners, steep).lateral;
}

// Axes and place of a camera, the place relative to the shape's centre.
struct Framing {
    glm::dvec3 backward, right, up, position;
    double distance;
};

// `corners` are those of a convex shape, relative to its centre. From the front, a little from the right and above.
Framing frame(const std::vector<glm::dvec3>& corners, double yfov, double aspectRatio)
{
    Framing framing{};
    framing.backward = glm::normalize(glm::dvec3(0.4, 0.3, 1.0));
    framing.right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), framing.backward));
    framing.up = glm::cross(framing.backward, framing.right);
    FrameCorners across, upwards;
    double nearest = 0.0;
    for (const glm::dvec3& corner : corners) {
        const double nearer = glm::dot(corner, framing.backward);
        across.push_back({glm::dot(corner, framing.right), nearer});
        upwards.push_back({glm::dot(corner, framing.up), nearer});
        nearest = std::max(nearest, nearer);
    }
    const double slope = (1.0 - 2.0 * kMargin) * std::tan(0.5 * yfov), wide = slope * aspectRatio;
    framing.distance = std::max({fit(across, wide).distance, fit(upwards, slope).distance, 1.01 * nearest});
    framing.position = framing.distance * framing.backward + centered(across, wide, framing.distance) * framing.right +
                       centered(upwards, slope, framing.distance) * framing.up;
    return framing;
}

glm::dvec3 centerOf(const WorldBox& box) { return 0.5 * glm::dvec3(box.low) + 0.5 * glm::dvec3(box.high); }

glm::dvec3 rotateAboutY(const glm::dvec3& v, double angle)
{
    return {std::cos(angle) * v.x + std::sin(angle) * v.z, v.y, std::cos(angle) * v.z - std::sin(angle) * v.x};
}

}  // namespace

Camera frameCamera(const Scene& scene, float aspectRatio, float yfov)
{
    const WorldBox box = computeWorldBox(scene);
    const glm::dvec3 center = centerOf(box);
    std::vector<glm::dvec3> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners.push_back(glm::dvec3((i & 1U) != 0 ? box.high.x : box.low.x, (i & 2U) != 0 ? box.high.y : box.low.y,
                                     (i & 4U) != 0 ? box.high.z : box.low.z) -
                          center);
    }
    Camera camera;
    camera.name = "framed";
    camera.aspectRatio = aspectRatio;
    camera.yfov = yfov;
    const Framing framing = frame(corners, static_cast<double>(camera.yfov), static_cast<double>(aspectRatio));
    camera.position = center + framing.position;
    camera.forward = -framing.backward;
    camera.right = framing.right;
    camera.up = framing.up;
    return camera;
}

std::vector<Pose> frameTurntable(const Scene& scene, float aspectRatio, std::uint32_t count, float yfov)
{
    constexpr int kSides = 64;  // of the prism around the cylinder in which the scene rotates
    constexpr double kTwoPi = 6.283185307179586;
    const WorldBox box = computeWorldBox(scene);
    const glm::dvec3 center = centerOf(box), up(0.0, 0.5 * (static_cast<double>(box.high.y) - static_cast<double>(box.low.y)), 0.0);
    const double radius = computeRadius(scene, center) / std::cos(0.5 * kTwoPi / kSides);
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < kSides; ++i) {
        const glm::dvec3 side = rotateAboutY({0.0, 0.0, radius}, kTwoPi * i / kSides);
        corners.push_back(side + up);
        corners.push_back(side - up);
    }
    const Framing framing = frame(corners, static_cast<double>(yfov), static_cast<double>(aspectRatio));
    std::vector<Pose> poses;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = kTwoPi * i / count;
        Pose pose;
        pose.from = scene.origin + center + rotateAboutY(framing.position, angle);
        pose.at = pose.from - framing.distance * rotateAboutY(framing.backward, angle);
        poses.push_back(pose);
    }
    return poses;
}

}  // namespace glim
