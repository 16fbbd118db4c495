#include "host/scene/placed_mesh.hpp"

#include <limits>

namespace glim {

glm::dvec3 faceNormal(const Triangle& triangle)
{
    const glm::dvec3 origin(triangle.vertices[0]);
    return glm::cross(glm::dvec3(triangle.vertices[1]) - origin, glm::dvec3(triangle.vertices[2]) - origin);
}

PlacedMesh::PlacedMesh(const Scene& scene, const MeshInstance& instance)
    : mesh_(&scene.meshes[instance.mesh])
{
    const glm::dmat3 linear(instance.worldFromMesh);
    // Moved close to zero first, so that far from the world's origin nothing is rounded away.
    const glm::dvec3 translation = glm::dvec3(instance.worldFromMesh[3]) - scene.origin;
    second_ = glm::determinant(linear) < 0.0 ? 2 : 1;
    positions_.reserve(mesh_->positions.size());
    for (const glm::dvec3& position : mesh_->positions) {
        positions_.emplace_back(linear * position + translation);  // the one place where vertices become float32
    }
}

std::array<std::uint32_t, 3> PlacedMesh::corners(std::size_t triangle) const
{
    const std::uint32_t* indices = mesh_->indices.data() + 3 * triangle;
    return {indices[0], indices[second_], indices[3 - second_]};
}

Triangle PlacedMesh::triangle(std::size_t triangle) const
{
    const auto [a, b, c] = corners(triangle);
    return {{positions_[a], positions_[b], positions_[c]}};
}

WorldBox computeWorldBox(const Scene& scene)
{
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    WorldBox box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    for (const MeshInstance& instance : scene.instances) {
        const PlacedMesh placed(scene, instance);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            if (faceNormal(triangle) == glm::dvec3(0.0)) {
                continue;  // has no surface
            }
            for (const glm::vec3& vertex : triangle.vertices) {
                box = {glm::min(box.low, vertex), glm::max(box.high, vertex)};
            }
        }
    }
    for (const Sphere& sphere : scene.spheres) {
        box = {glm::min(box.low, sphere.center - sphere.radius), glm::max(box.high, sphere.center + sphere.radius)};
    }
    return box;
}

}  // namespace glim
