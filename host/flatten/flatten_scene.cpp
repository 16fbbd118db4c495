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

bool isSliver(const Triangle& triangle)
{
    const glm::dvec3 v0 = triangle.vertices[0], v1 = triangle.vertices[1], v2 = triangle.vertices[2];
    const glm::dvec3 a = v1 - v0, b = v2 - v1, c = v0 - v2;
    const double square = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
    return glm::length(glm::cross(a, c)) < static_cast<double>(kSliverHeight) * square;
}

void pushTriangle(FlatScene& flat, const Triangle& triangle, std::uint32_t id, std::uint32_t material)
{
    const bool sliver = isSliver(triangle);
    flat.features |= sliver ? kFeatureSlivers : 0U;
    flat.records.push_back(texel(triangle.vertices[0], id));
    flat.records.push_back(texel(triangle.vertices[1], material | (sliver ? kSliverBit : 0U)));
    flat.records.push_back(texel(triangle.vertices[2], 0));
}

void pushSphere(FlatScene& flat, const Sphere& sphere, std::uint32_t id)
{
    flat.records.push_back(texel(sphere.center, id));
    flat.records.push_back(texel({sphere.radius, 0.0F, 0.0F}, sphere.material | kSphereBit));
    flat.records.push_back(texel({0.0F, 0.0F, 0.0F}, 0));
}

// Returns one record per primitive: the last one if it has several.
std::vector<std::uint32_t> pushRecords(FlatScene& flat, const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    std::vector<std::uint32_t> materials;  // by triangle
    materials.reserve(primitives.triangles.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        materials.resize(primitives.firstTriangles[i + 1], scene.meshes[scene.instances[i].mesh].material);
    }
    std::vector<std::uint32_t> recordOf(primitives.count());
    flat.records.reserve(bvh.order.size() * kRecordTexels);
    for (std::uint32_t record = 0; record < bvh.order.size(); ++record) {
        const std::uint32_t id = bvh.order[record];
        recordOf[id] = record;
        if (id < materials.size()) {
            pushTriangle(flat, primitives.triangles[id], id, materials[id]);
        } else {
            pushSphere(flat, primitives.spheres[id - materials.size()], id);
        }
    }
    return recordOf;
}

void pushShading(FlatScene& flat, const Primitives& primitives)
{
    flat.triangles.reserve(primitives.vertexIndices.size());
    for (const glm::uvec3& vertices : primitives.vertexIndices) {
        flat.triangles.emplace_back(vertices, 0U);
    }
    flat.vertices.reserve(primitives.vertexNormals.size());
    for (const glm::vec3& normal : primitives.vertexNormals) {
        flat.vertices.push_back(texel(normal, 0));
    }
}

// Marks the other records of each emitting primitive; addLights has marked one.
void markOtherRecords(FlatScene& flat, std::span<const std::uint32_t> order, std::span<const std::uint32_t> recordOf)
{
    if (order.size() == recordOf.size()) {
        return;  // each primitive has one
    }
    for (std::size_t record = 0; record < order.size(); ++record) {
        const std::size_t marked = recordOf[order[record]];
        flat.records[record * kRecordTexels + 2].w = flat.records[marked * kRecordTexels + 2].w;
    }
}

static_assert(static_cast<std::uint32_t>(Scattering::Lambert) == kLambert && static_cast<std::uint32_t>(Scattering::Mirror) == kMirror);
static_assert(static_cast<std::uint32_t>(Scattering::Dielectric) == kDielectric);

std::uint32_t featureOf(Scattering scattering)
{
    switch (scattering) {
    case Scattering::Lambert: break;
    case Scattering::Mirror: return kFeatureMirror;
    case Scattering::Dielectric: return kFeatureDielectric;
    }
    return 0;
}

// A multiple of four, so that scenes of about the same size share compiled kernels.
std::uint32_t stackLevelsOf(const WideBvh& bvh) { return std::max((bvh.depth + 1) / 4 * 4, 4U); }

static_assert(kMaxStackLevels % 4 == 0);

}  // namespace

FlatScene flattenScene(const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    FlatScene flat;
    flat.nodes = packNodes(bvh);
    flat.stackLevels = stackLevelsOf(bvh);
    flat.features = (primitives.spheres.empty() ? 0U : kFeatureSpheres) | (primitives.vertexNormals.empty() ? 0U : kFeatureSmooth);
    for (const Material& m : scene.materials) {
        flat.materials.push_back(
            {m.baseColor, static_cast<std::uint32_t>(m.scattering), m.emission, m.ior, m.doubleSided ? 1U : 0U, uvec3(0)});
    }
    for (const MeshInstance& instance : scene.instances) {
        flat.features |= featureOf(scene.materials[scene.meshes[instance.mesh].material].scattering);
    }
    for (const Sphere& sphere : scene.spheres) {
        flat.features |= featureOf(scene.materials[sphere.material].scattering);
    }
    pushShading(flat, primitives);
    const std::vector<std::uint32_t> recordOf = pushRecords(flat, scene, primitives, bvh);
    addLights(flat, scene, primitives, recordOf);
    markOtherRecords(flat, bvh.order, recordOf);
    return flat;
}

FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens)
{
    const bool perspective = camera.kind == Camera::Kind::Perspective;
    const float halfHeight = perspective ? std::tan(0.5F * camera.yfov) : camera.halfHeight;
    return {camera.position,
            camera.right * (halfHeight * aspectRatio),
            camera.up * halfHeight,
            camera.forward,
            perspective ? kPerspective : kOrthographic,
            camera.right * lens.radius,
            camera.up * lens.radius,
            1.0F / lens.focalDistance};
}

}  // namespace glim
