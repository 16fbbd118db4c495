#include "host/scene/placed_mesh.hpp"

#include "host/scene/share_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

namespace glim {

glm::dvec3 faceNormal(const Triangle& triangle)
{
    const glm::dvec3 origin(triangle.vertices[0]);
    return glm::cross(glm::dvec3(triangle.vertices[1]) - origin, glm::dvec3(triangle.vertices[2]) - origin);
}

PlacedMesh::PlacedMesh(const Scene& scene, const MeshInstance& instance)
    // Moved close to zero first, so that far from the world's origin nothing is rounded away.
    : PlacedMesh(scene.meshes[instance.mesh], glm::dmat3(instance.worldFromMesh), glm::dvec3(instance.worldFromMesh[3]) - scene.origin)
{}

PlacedMesh::PlacedMesh(const Mesh& mesh, const glm::dmat3& linear, const glm::dvec3& translation)
    : mesh_(&mesh),
      second_(glm::determinant(linear) < 0.0 ? 2 : 1)
{
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

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

WorldBox computeMeshBox(const Mesh& mesh)
{
    WorldBox box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    for (const std::uint32_t index : mesh.indices) {
        box = {glm::min(box.low, glm::vec3(mesh.positions[index])), glm::max(box.high, glm::vec3(mesh.positions[index]))};
    }
    return box;
}

// Of what the box holds, as the instance places it.
WorldBox placeBox(const Scene& scene, const MeshInstance& instance, const WorldBox& box)
{
    const glm::dmat3 linear(instance.worldFromMesh);
    const glm::dvec3 center = 0.5 * (glm::dvec3(box.low) + glm::dvec3(box.high)), half = glm::dvec3(box.high) - center;
    const glm::dvec3 placed = linear * center + glm::dvec3(instance.worldFromMesh[3]) - scene.origin;
    const glm::dvec3 extent = glm::abs(linear[0]) * half.x + glm::abs(linear[1]) * half.y + glm::abs(linear[2]) * half.z;
    return {glm::vec3(placed - extent), glm::vec3(placed + extent)};
}

std::span<const MeshInstance> ownInstances(const Scene& scene)
{
    return std::span(scene.instances).first(scene.instances.size() - scene.addedInstances);
}

std::span<const Sphere> ownSpheres(const Scene& scene) { return std::span(scene.spheres).first(scene.spheres.size() - scene.addedSpheres); }

// Calls `take` with every vertex of a triangle that has a surface and was not added.
template <class Take>
void visitVertices(const Scene& scene, Take take)
{
    for (const MeshInstance& instance : ownInstances(scene)) {
        const PlacedMesh placed(scene, instance);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            if (faceNormal(triangle) != glm::dvec3(0.0)) {
                std::for_each(std::begin(triangle.vertices), std::end(triangle.vertices), take);
            }
        }
    }
}

WorldBox computeTriangleBox(const Scene& scene)
{
    WorldBox box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    visitVertices(scene, [&box](const glm::vec3& vertex) { box = {glm::min(box.low, vertex), glm::max(box.high, vertex)}; });
    return box;
}

bool isLarge(const Scene& scene) { return countTriangles(countMeshUses(scene)) > kMaxFlatTriangles; }

// Quicker, and larger where meshes are turned.
WorldBox computeBoxOfMeshBoxes(const Scene& scene)
{
    std::vector<WorldBox> meshes;
    for (const Mesh& mesh : scene.meshes) {
        meshes.push_back(computeMeshBox(mesh));
    }
    WorldBox box{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    for (const MeshInstance& instance : ownInstances(scene)) {
        if (!scene.meshes[instance.mesh].indices.empty()) {
            const WorldBox placed = placeBox(scene, instance, meshes[instance.mesh]);
            box = {glm::min(box.low, placed.low), glm::max(box.high, placed.high)};
        }
    }
    return box;
}

}  // namespace

WorldBox computeWorldBox(const Scene& scene)
{
    WorldBox box = isLarge(scene) ? computeBoxOfMeshBoxes(scene) : computeTriangleBox(scene);
    for (const Sphere& sphere : ownSpheres(scene)) {
        box = {glm::min(box.low, sphere.center - sphere.radius), glm::max(box.high, sphere.center + sphere.radius)};
    }
    return box.low.x <= box.high.x ? box : WorldBox{glm::vec3(-1.0F), glm::vec3(1.0F)};
}

double computeRadius(const Scene& scene, const glm::dvec3& center)
{
    if (isLarge(scene)) {
        const WorldBox box = computeWorldBox(scene);
        const glm::dvec3 far = glm::max(glm::dvec3(box.high) - center, center - glm::dvec3(box.low));
        return std::hypot(far.x, far.z);
    }
    double radius = 0.0;
    const auto distance = [&center](const glm::dvec3& point) { return std::hypot(point.x - center.x, point.z - center.z); };
    visitVertices(scene, [&](const glm::vec3& vertex) { radius = std::max(radius, distance(vertex)); });
    for (const Sphere& sphere : ownSpheres(scene)) {
        radius = std::max(radius, distance(sphere.center) + static_cast<double>(sphere.radius));
    }
    return radius;
}

}  // namespace glim
