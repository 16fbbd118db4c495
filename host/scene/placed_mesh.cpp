#include "host/scene/placed_mesh.hpp"

#include "host/scene/share_meshes.hpp"
#include "host/scene/uniform_scale.hpp"

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
    : PlacedMesh(scene.meshes[instance.mesh], Placing(scene, instance))
{}

PlacedMesh::PlacedMesh(const Mesh& mesh, const Placing& place)
    : mesh_(&mesh),
      second_(glm::determinant(place.linear) < 0.0 ? 2 : 1)
{
    positions_.reserve(mesh_->positions.size());
    for (const glm::dvec3& position : mesh_->positions) {
        positions_.push_back(place(position));
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

float computePointRadius(const Scene& scene, const MeshInstance& instance)
{
    const Mesh& mesh = scene.meshes[instance.mesh];
    const std::optional<double>& ofAll = mesh.lines.empty() ? scene.pointRadius : scene.lineRadius;
    if (ofAll || mesh.pointRadius == 0.0) {
        return static_cast<float>(ofAll.value_or(scene.lonePointRadius));
    }
    const glm::dmat3 linear(instance.worldFromMesh);
    const double even = computeUniformScale(linear);
    return static_cast<float>(mesh.pointRadius * (even > 0.0 ? even : std::cbrt(std::abs(glm::determinant(linear)))));
}

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr WorldBox kEmptyWorldBox{glm::vec3(kInfinity), glm::vec3(-kInfinity)};

WorldBox computeMeshBox(const Mesh& mesh)
{
    WorldBox box = kEmptyWorldBox;
    if (mesh.isCloud) {
        for (const glm::dvec3& position : mesh.positions) {
            box = {glm::min(box.low, glm::vec3(position)), glm::max(box.high, glm::vec3(position))};
        }
    }
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
    glm::dvec3 extent = glm::abs(linear[0]) * half.x + glm::abs(linear[1]) * half.y + glm::abs(linear[2]) * half.z;
    extent += scene.meshes[instance.mesh].isCloud ? static_cast<double>(computePointRadius(scene, instance)) : 0.0;
    return {glm::vec3(placed - extent), glm::vec3(placed + extent)};
}

std::span<const Sphere> ownSpheres(const Scene& scene) { return std::span(scene.spheres).first(scene.spheres.size() - scene.addedSpheres); }

WorldBox unite(const WorldBox& a, const WorldBox& b) { return {glm::min(a.low, b.low), glm::max(a.high, b.high)}; }

WorldBox boxOf(const Sphere& sphere) { return {sphere.center - sphere.radius, sphere.center + sphere.radius}; }

float longestSide(const glm::vec3& extent) { return std::max({extent.x, extent.y, extent.z}); }

// An instance that has triangles or points, and a box around it that may be larger than it where it is turned.
struct PlacedBox {
    const MeshInstance* instance;
    WorldBox box;

    glm::vec3 extent() const { return box.high - box.low; }
    bool isFlat() const { return extent().y <= 0.05F * std::max(extent().x, extent().z); }
};

std::vector<PlacedBox> placeOwnBoxes(const Scene& scene)
{
    std::vector<WorldBox> meshes;
    for (const Mesh& mesh : scene.meshes) {
        meshes.push_back(computeMeshBox(mesh));
    }
    std::vector<PlacedBox> boxes;
    for (const MeshInstance& instance : std::span(scene.instances).first(scene.instances.size() - scene.addedInstances)) {
        if (const Mesh& mesh = scene.meshes[instance.mesh]; mesh.isCloud || !mesh.indices.empty()) {
            boxes.push_back({&instance, placeBox(scene, instance, meshes[instance.mesh])});
        }
    }
    return boxes;
}

// What was not added, without grounds: what is flat and several times as long as all that is not.
std::vector<PlacedBox> listSubjects(const Scene& scene)
{
    constexpr float kGround = 5.0F;
    std::vector<PlacedBox> boxes = placeOwnBoxes(scene);
    WorldBox upright = kEmptyWorldBox;
    for (const PlacedBox& placed : boxes) {
        upright = placed.isFlat() ? upright : unite(upright, placed.box);
    }
    for (const Sphere& sphere : ownSpheres(scene)) {
        upright = unite(upright, boxOf(sphere));
    }
    const float longest = longestSide(upright.high - upright.low);
    if (longest > 0.0F) {
        std::erase_if(boxes, [&](const PlacedBox& placed) { return placed.isFlat() && longestSide(placed.extent()) > kGround * longest; });
    }
    return boxes;
}

// Calls `take` with every vertex of a subject's triangle that has a surface.
template <class Take>
void visitVertices(const Scene& scene, Take take)
{
    for (const PlacedBox& subject : listSubjects(scene)) {
        const PlacedMesh placed(scene, *subject.instance);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            if (faceNormal(triangle) != glm::dvec3(0.0)) {
                std::for_each(std::begin(triangle.vertices), std::end(triangle.vertices), take);
            }
        }
    }
}

// Calls `take` with the centre and the radius of each of a subject's points.
template <class Take>
void visitPoints(const Scene& scene, Take take)
{
    for (const PlacedBox& subject : listSubjects(scene)) {
        if (scene.meshes[subject.instance->mesh].isCloud) {
            const float radius = computePointRadius(scene, *subject.instance);
            const PlacedMesh placed(scene, *subject.instance);
            for (const glm::vec3& center : placed.positions()) {
                take(center, radius);
            }
        }
    }
}

WorldBox computeShapeBox(const Scene& scene)
{
    WorldBox box = kEmptyWorldBox;
    visitVertices(scene, [&box](const glm::vec3& vertex) { box = {glm::min(box.low, vertex), glm::max(box.high, vertex)}; });
    visitPoints(scene, [&box](const glm::vec3& center, float radius) { box = unite(box, {center - radius, center + radius}); });
    return box;
}

bool isLarge(const Scene& scene) { return countTriangles(countMeshUses(scene)) > kMaxFlatTriangles; }

// Quicker, and larger where meshes are turned.
WorldBox computeBoxOfMeshBoxes(const Scene& scene)
{
    WorldBox box = kEmptyWorldBox;
    for (const PlacedBox& subject : listSubjects(scene)) {
        box = unite(box, subject.box);
    }
    return box;
}

}  // namespace

WorldBox computeWorldBox(const Scene& scene)
{
    WorldBox box = isLarge(scene) ? computeBoxOfMeshBoxes(scene) : computeShapeBox(scene);
    for (const Sphere& sphere : ownSpheres(scene)) {
        box = unite(box, boxOf(sphere));
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
    visitPoints(scene, [&](const glm::vec3& point, float own) { radius = std::max(radius, distance(point) + static_cast<double>(own)); });
    for (const Sphere& sphere : ownSpheres(scene)) {
        radius = std::max(radius, distance(sphere.center) + static_cast<double>(sphere.radius));
    }
    return radius;
}

}  // namespace glim
