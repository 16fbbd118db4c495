#include "host/scene/frame_camera.hpp"

#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace glim {

Camera frameCamera(const Scene& scene, float aspectRatio)
{
    const auto [low, high] = computeWorldBox(scene);
    Camera camera;
    camera.name = "framed";
    const glm::dvec3 center = 0.5 * glm::dvec3(low) + 0.5 * glm::dvec3(high);
    const double radius = 0.5 * glm::length(glm::dvec3(high) - glm::dvec3(low));
    // The sphere around the box just fits into the narrower of the two fields of view.
    const double slope = std::tan(0.5 * static_cast<double>(camera.yfov)) * std::min(1.0, static_cast<double>(aspectRatio));
    const double distance = radius / std::sin(std::atan(slope));
    const glm::dvec3 backward = glm::normalize(glm::dvec3(0.4, 0.3, 1.0));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), backward));
    camera.position = center + distance * backward;
    camera.forward = -backward;
    camera.right = right;
    camera.up = glm::cross(backward, right);
    return camera;
}

}  // namespace glim
