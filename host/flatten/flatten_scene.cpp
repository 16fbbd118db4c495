#include "host/flatten/flatten_scene.hpp"

#include "host/flatten/light_table.hpp"
#include "host/flatten/pack_nodes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace glim {
namespace {

uvec4 texel(const glm::vec3& v, std::uint32_t w)
{
    return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z), w};
}

// The material of each triangle, and whether its normals count.
std::vector<const Primitive*> primitiveOfTriangle(const Scene& scene)
{
    std::vector<const Primitive*> owners(scene.triangles.size(), nullptr);
    for (const Primitive& primitive : scene.primitives) {
        std::fill_n(owners.begin() + primitive.firstTriangle, primitive.triangleCount, &primitive);
    }
    return owners;
}

bool isSliver(const Triangle& triangle)
{
    const glm::dvec3 v0 = triangle.vertices[0], v1 = triangle.vertices[1], v2 = triangle.vertices[2];
    const glm::dvec3 a = v1 - v0, b = v2 - v1, c = v0 - v2;
    const double square = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    return glm::length(glm::cross(a, c)) < static_cast<double>(kSliverHeight) * square;
}

void pushTriangle(FlatScene& flat, const Scene& scene, std::uint32_t id, const Primitive& owner)
{
    const Triangle& triangle = scene.triangles[id];
    const bool sliver = isSliver(triangle);
    flat.features.slivers = flat.features.slivers || sliver;
    flat.records.push_back(texel(triangle.vertices[0], id));
    flat.records.push_back(texel(triangle.vertices[1], owner.material | (sliver ? kSliverBit : 0U)));
    flat.records.push_back(texel(triangle.vertices[2], 0));
}

void pushSphere(FlatScene& flat, const Scene& scene, std::uint32_t id)
{
    const Sphere& sphere = scene.spheres[id - scene.triangles.size()];
    flat.records.push_back(texel(sphere.center, id));
    flat.records.push_back(texel({sphere.radius, 0.0F, 0.0F}, sphere.material | kSphereBit));
    flat.records.push_back(texel({0.0F, 0.0F, 0.0F}, 0));
}

void pushNormals(FlatScene& flat, const Scene& scene, std::uint32_t id, const Primitive* owner)
{
    const bool smooth = owner != nullptr && owner->smooth;
    for (int k = 0; k < 3; ++k) {
        flat.normals.push_back(texel(smooth ? scene.normals[id].normals[k] : glm::vec3(0.0F), 0));
    }
}

// As addLights has marked one record of each primitive that emits.
void markOtherRecords(FlatScene& flat, std::span<const std::uint32_t> order, std::span<const std::uint32_t> recordOf)
{
    if (order.size() == recordOf.size()) {
        return;  // none has another
    }
    for (std::size_t record = 0; record < order.size(); ++record) {
        const std::size_t marked = recordOf[order[record]];
        flat.records[record * kRecordTexels + 2].w = flat.records[marked * kRecordTexels + 2].w;
    }
}

// In fours, so that scenes of about the same size share what the driver has compiled.
std::uint32_t stackLevelsOf(const WideBvh& bvh)
{
    return std::max((bvh.depth + 1) / 4 * 4, 4U);
}

static_assert(kMaxStackLevels % 4 == 0);

}  // namespace

FlatScene flattenScene(const Scene& scene, const WideBvh& bvh)
{
    FlatScene flat;
    flat.nodes = packNodes(bvh);
    flat.features.stackLevels = stackLevelsOf(bvh);
    flat.features.spheres = !scene.spheres.empty();
    flat.features.smooth = std::any_of(scene.primitives.begin(), scene.primitives.end(),
                                       [](const Primitive& primitive) { return primitive.smooth; });
    for (const Material& m : scene.materials) {
        flat.materials.push_back({m.baseColor, static_cast<std::uint32_t>(m.scattering), m.emission, m.ior,
                                  m.doubleSided ? 1U : 0U, uvec3(0)});
        flat.features.mirrors = flat.features.mirrors || m.scattering == Scattering::Mirror;
        flat.features.glasses = flat.features.glasses || m.scattering == Scattering::Glass;
    }
    const std::vector<const Primitive*> owners = primitiveOfTriangle(scene);
    std::vector<std::uint32_t> recordOf(scene.triangles.size() + scene.spheres.size());
    for (std::uint32_t record = 0; record < bvh.order.size(); ++record) {
        const std::uint32_t id = bvh.order[record];
        const Primitive* owner = id < owners.size() ? owners[id] : nullptr;
        recordOf[id] = record;
        if (owner != nullptr) {
            pushTriangle(flat, scene, id, *owner);
        } else {
            pushSphere(flat, scene, id);
        }
        if (flat.features.smooth) {
            pushNormals(flat, scene, id, owner);
        }
    }
    addLights(flat, scene, recordOf);
    markOtherRecords(flat, bvh.order, recordOf);
    return flat;
}

FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens)
{
    const bool perspective = camera.kind == Camera::Kind::Perspective;
    const float halfHeight = perspective ? std::tan(0.5F * camera.yfov) : camera.halfHeight;
    return {camera.position, camera.right * (halfHeight * aspectRatio), camera.up * halfHeight, camera.forward,
            perspective ? kPerspective : kOrthographic, camera.right * lens.radius, camera.up * lens.radius,
            1.0F / lens.focalDistance};
}

}  // namespace glim
