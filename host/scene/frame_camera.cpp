#include "host/scene/frame_camera.hpp"

#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glim {
namespace {

// What stays free on each side of the picture, as a share of it.
constexpr double kMargin = 0.05;

// The corners of a box as a camera sees them from far away along one axis of its picture: how far aside, and how much nearer than the
// box's centre.
struct Corner {
    double aside, nearer;
};

using Corners = std::array<Corner, 8>;

// Where the camera stands on that axis, if corners at the least and the greatest slope against the view direction are to be as steep as
// each other: `aside`. `distance` of the camera from the centre: where this slope is `slope`.
struct Place {
    double aside, distance;
};

Place fit(const Corners& corners, double slope)
{
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (const Corner& corner : corners) {
        high = std::max(high, corner.aside + slope * corner.nearer);
        low = std::min(low, corner.aside - slope * corner.nearer);
    }
    return {0.5 * (high + low), 0.5 * (high - low) / slope};
}

// Where the box's picture is in the middle for a camera at `distance`, which is at least that of fit(corners, slope).
double centered(const Corners& corners, double slope, double distance)
{
    double flat = 0.0, steep = slope;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (flat + steep);
        (fit(corners, middle).distance > distance ? flat : steep) = middle;
    }
    return fit(corners, steep).aside;
}

}  // namespace

Camera frameCamera(const Scene& scene, float aspectRatio)
{
    const auto [low, high] = computeWorldBox(scene);
    Camera camera;
    camera.name = "framed";
    const glm::dvec3 center = 0.5 * glm::dvec3(low) + 0.5 * glm::dvec3(high);
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.4, 0.3, 1.0));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), backward)), up = glm::cross(backward, right);
    Corners across{}, upwards{};
    double nearest = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
        const glm::dvec3 corner =
            glm::dvec3((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z) - center;
        const double nearer = glm::dot(corner, backward);
        across[i] = {glm::dot(corner, right), nearer};
        upwards[i] = {glm::dot(corner, up), nearer};
        nearest = std::max(nearest, nearer);
    }
    const double slope = (1.0 - 2.0 * kMargin) * std::tan(0.5 * static_cast<double>(camera.yfov));
    const double wide = slope * static_cast<double>(aspectRatio);
    const double distance = std::max({fit(across, wide).distance, fit(upwards, slope).distance, 1.01 * nearest});
    camera.position = center + distance * backward + centered(across, wide, distance) * right + centered(upwards, slope, distance) * up;
    camera.forward = -backward;
    camera.right = right;
    camera.up = up;
    return camera;
}

}  // namespace glim
