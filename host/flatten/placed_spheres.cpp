#include "host/flatten/placed_spheres.hpp"

#include <algorithm>
#include <iterator>

namespace glim {

Box computeBox(const PlacedSphere& sphere)
{
    const glm::vec3 end = sphere.center + sphere.axis;
    return roundOutwards({glm::min(sphere.center, end) - sphere.radius, glm::max(sphere.center, end) + sphere.radius});
}

PlacedSpheres::PlacedSpheres(const Scene& scene)
    : meshes_(scene.meshes)
{
    auto object = static_cast<std::uint32_t>(scene.instances.size());
    for (const Sphere& sphere : scene.spheres) {
        own_.push_back({sphere.center, sphere.radius, sphere.material, object++, kNoIndex});
    }
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const MeshInstance& instance = scene.instances[i];
        const Mesh& mesh = meshes_[instance.mesh];
        if (const std::size_t points = mesh.lines.empty() ? mesh.positions.size() : mesh.lines.size(); mesh.isCloud && points > 0) {
            clouds_.push_back({count_, i, instance.mesh, computePointRadius(scene, instance), Placing(scene, instance)});
            count_ += points;
        }
    }
}

const PlacedSpheres::Cloud& PlacedSpheres::findCloud(std::size_t point) const
{
    return *std::prev(std::ranges::upper_bound(clouds_, point, {}, &Cloud::first));
}

PlacedSphere PlacedSpheres::operator[](std::size_t i) const
{
    const std::size_t at = order_ ? (*order_)[i] : i;
    if (at < own_.size()) {
        return own_[at];
    }
    const Cloud& cloud = findCloud(at - own_.size());
    const Mesh& mesh = meshes_[cloud.mesh];
    const auto point = static_cast<std::uint32_t>(at - own_.size() - cloud.first);
    PlacedSphere sphere{{}, cloud.radius, mesh.material, cloud.instance, point};
    if (mesh.lines.empty()) {
        sphere.center = cloud.place(mesh.positions[point]);
    } else {
        sphere.center = cloud.place(mesh.positions[mesh.lines[point].x]);
        sphere.axis = cloud.place(mesh.positions[mesh.lines[point].y]) - sphere.center;
    }
    return sphere;
}

glm::vec4 PlacedSpheres::computeColor(const PlacedSphere& sphere) const
{
    if (sphere.point == kNoIndex) {
        return glm::vec4(1.0F);
    }
    const auto cloud = std::ranges::lower_bound(clouds_, sphere.object, {}, &Cloud::instance);
    const Mesh& mesh = meshes_[cloud->mesh];
    if (mesh.colors.empty()) {
        return glm::vec4(1.0F);
    }
    const auto colorOf = [&mesh](std::uint32_t vertex) { return glm::clamp(mesh.colors[vertex], 0.0F, 1.0F); };
    if (mesh.lines.empty()) {
        return colorOf(sphere.point);
    }
    const glm::uvec2 ends = mesh.lines[sphere.point];
    return 0.5F * (colorOf(ends.x) + colorOf(ends.y));
}

void PlacedSpheres::select(std::vector<std::uint32_t> order)
{
    for (std::uint32_t& at : order) {
        at = order_ ? (*order_)[at] : at;
    }
    order_ = std::move(order);
}

}  // namespace glim
