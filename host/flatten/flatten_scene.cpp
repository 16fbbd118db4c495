#include "host/flatten/flatten_scene.hpp"

#include "host/error.hpp"
#include "host/flatten/albedo_table.hpp"
#include "host/flatten/anisotropic_albedo.hpp"
#include "host/flatten/caustics.hpp"
#include "host/flatten/flatten_materials.hpp"
#include "host/flatten/large_triangles.hpp"
#include "host/flatten/light_table.hpp"
#include "host/flatten/pack_nodes.hpp"
#include "host/flatten/place_instances.hpp"
#include "host/flatten/start_media.hpp"

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

// What records say of each material.
std::vector<std::uint32_t> materialWordsOf(const Scene& scene)
{
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
        words.push_back(i | (scene.showsBackFaces || meetsBackFaces(scene.materials[i]) ? 0U : kSingleSidedBit));
    }
    return words;
}

void pushTriangle(FlatScene& flat, const Triangle& triangle, std::uint32_t id, std::uint32_t material, bool alpha)
{
    const bool sliver = isSliver(triangle);
    flat.features |= (sliver ? kFeatureSlivers : 0U) | ((material & kSingleSidedBit) != 0 ? kFeatureSingleSided : 0U);
    flat.records.push_back(texel(triangle.vertices[0], id));
    flat.records.push_back(texel(triangle.vertices[1], material | (sliver ? kSliverBit : 0U) | (alpha ? kAlphaBit : 0U)));
    flat.records.push_back(texel(triangle.vertices[2], 0));
}

void pushSphere(FlatScene& flat, const Sphere& sphere, std::uint32_t id, std::uint32_t material, bool alpha)
{
    flat.features |= (material & kSingleSidedBit) != 0 ? kFeatureSingleSided : 0U;
    flat.records.push_back(texel(sphere.center, id));
    flat.records.push_back(texel({sphere.radius, 0.0F, 0.0F}, material | kSphereBit | (alpha ? kAlphaBit : 0U)));
    flat.records.push_back(texel({0.0F, 0.0F, 0.0F}, 0));
}

// Returns one record per primitive: the last one if it has several.
std::vector<std::uint32_t> pushRecords(FlatScene& flat, const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    const std::vector<std::uint32_t> words = materialWordsOf(scene);
    std::vector<std::uint32_t> materials;  // by triangle
    materials.reserve(primitives.triangles.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        materials.resize(primitives.firstTriangles[i + 1], words[scene.meshes[scene.instances[i].mesh].material]);
    }
    std::vector<std::uint32_t> recordOf(primitives.count());
    flat.records.reserve(bvh.order.size() * kRecordTexels);
    for (std::uint32_t record = 0; record < bvh.order.size(); ++record) {
        const std::uint32_t id = bvh.order[record];
        if (id >= primitives.count()) {
            break;  // shared meshes follow
        }
        recordOf[id] = record;
        const bool alpha = !primitives.hasAlpha.empty() && primitives.hasAlpha[id];
        flat.features |= alpha ? kFeatureAlpha : 0U;
        if (id < materials.size()) {
            pushTriangle(flat, primitives.triangles[id], id, materials[id], alpha);
        } else {
            const Sphere& sphere = primitives.spheres[id - materials.size()];
            pushSphere(flat, sphere, id, words[sphere.material], alpha);
        }
    }
    return recordOf;
}

void pushSharedRecords(FlatScene& flat, const Scene& scene, const Primitives& primitives, const WideBvh& bvh)
{
    const std::vector<std::uint32_t> words = materialWordsOf(scene);
    for (std::size_t i = 0; i < bvh.meshTrees.size(); ++i) {
        const SharedMesh& mesh = primitives.sharedMeshes[i];
        const std::uint32_t material = words[scene.meshes[mesh.mesh].material];
        for (std::uint32_t k = 0; k < bvh.meshTrees[i].entryCount; ++k) {
            const std::uint32_t triangle = bvh.order[bvh.meshTrees[i].firstEntry + k] - mesh.firstId;
            flat.features |= mesh.hasAlpha[triangle] ? kFeatureAlpha : 0U;
            pushTriangle(flat, mesh.triangles[triangle], mesh.firstId + triangle, material, mesh.hasAlpha[triangle]);
        }
    }
}

// After all records.
void pushInstances(FlatScene& flat, const Primitives& primitives, const WideBvh& bvh)
{
    constexpr std::uint64_t kMost = kNoRecord;
    flat.firstInstanceRecord = static_cast<std::uint32_t>(bvh.order.size());
    std::uint64_t record = flat.firstInstanceRecord, primitive = primitives.count();
    for (const Placement& placement : primitives.placements) {
        const MeshTree& tree = bvh.meshTrees[placement.sharedMesh];
        const SharedMesh& mesh = primitives.sharedMeshes[placement.sharedMesh];
        InstanceData data = placeInstance(placement, tree.box);
        data.beginRecord = static_cast<std::uint32_t>(record);
        data.firstRecord = data.beginRecord - tree.firstEntry;
        data.firstPrimitive = static_cast<std::uint32_t>(primitive) - mesh.firstId;
        record += tree.entryCount;
        primitive += mesh.triangles.size();
        if (std::max(record, primitive) >= kMost) {
            throw InputError("the scene's instances have " + std::to_string(primitives.computeTriangleCount()) +
                             " triangles; expected fewer than 4294967295.");
        }
        const auto* texels = reinterpret_cast<const uvec4*>(&data);
        flat.instances.insert(flat.instances.end(), texels, texels + kInstanceTexels);
    }
    for (const InstanceNode& node : bvh.instances) {
        const auto rows = meshFromScene(primitives.placements[node.instance]);
        uvec4* texels = &flat.nodes[std::size_t{node.node} * kNodeTexels];
        const uvec4* instance = &flat.instances[std::size_t{node.instance} * kInstanceTexels];
        texels[0] = std::bit_cast<uvec4>(rows[0]);
        texels[1] = {node.root, 0, 0, 0};
        texels[2] = std::bit_cast<uvec4>(rows[1]);
        texels[3] = std::bit_cast<uvec4>(rows[2]);
        texels[4] = {instance[1].w, instance[2].w, 0, 0};
    }
    flat.features |= primitives.placements.empty() ? 0U : kFeatureInstances;
}

void pushShading(FlatScene& flat, const Primitives& primitives)
{
    flat.triangleCount = static_cast<std::uint32_t>(primitives.triangles.size());
    flat.triangles.reserve(primitives.vertexIndices.size());
    for (const glm::uvec3& vertices : primitives.vertexIndices) {
        flat.triangles.emplace_back(vertices, 0U);
    }
    for (const SharedMesh& mesh : primitives.sharedMeshes) {
        flat.triangles.resize(mesh.vertexIndices.empty() ? flat.triangles.size() : std::max(flat.triangles.size(), primitives.count()));
        for (const glm::uvec3& vertices : mesh.vertexIndices) {
            flat.triangles.emplace_back(vertices, 0U);
        }
    }
    for (const glm::vec3& normal : primitives.vertexNormals) {
        flat.vertices.push_back(texel(normal, 0));
        flat.features |= normal != glm::vec3(0.0F) ? kFeatureSmooth : 0U;
    }
    const auto pushSection = [&flat](const std::vector<glm::vec4>& values, std::uint32_t& first) {
        first = values.empty() ? 0 : static_cast<std::uint32_t>(flat.vertices.size());
        for (const glm::vec4& value : values) {
            flat.vertices.push_back(texel(glm::vec3(value), std::bit_cast<std::uint32_t>(value.w)));
        }
    };
    pushSection(primitives.vertexUvs, flat.firstUv);
    pushSection(primitives.vertexTangents, flat.firstTangent);
    pushSection(primitives.vertexColors, flat.firstColor);
    flat.features |= primitives.vertexColors.empty() ? 0U : kFeatureVertexColors;
}

// Which materials are drawn with vertex colours.
std::vector<bool> findColored(const Scene& scene)
{
    std::vector<bool> colored(scene.materials.size(), false);
    for (const MeshInstance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        colored[mesh.material] = colored[mesh.material] || !mesh.colors.empty();
    }
    return colored;
}

// Marks the other records of each emitting primitive; addLights has marked one.
void markOtherRecords(FlatScene& flat, std::span<const std::uint32_t> order, std::span<const std::uint32_t> recordOf)
{
    if (order.size() == recordOf.size()) {
        return;  // each primitive has one
    }
    for (std::size_t record = 0; record < order.size() && order[record] < recordOf.size(); ++record) {
        const std::size_t marked = recordOf[order[record]];
        flat.records[record * kRecordTexels + 2].w = flat.records[marked * kRecordTexels + 2].w;
    }
}

// A multiple of four, so that scenes of about the same size share compiled kernels.
std::uint32_t stackLevelsOf(const WideBvh& bvh) { return std::max((bvh.depth + 1) / 4 * 4, 4U); }

static_assert(kMaxStackLevels % 4 == 0);

}  // namespace

FlatScene flattenScene(const Scene& scene, const Primitives& primitives, const WideBvh& bvh, const FlatScene& previous)
{
    FlatScene flat;
    flat.images = previous.images;
    if (scene.environment && scene.environment->radiance != glm::vec3(0.0F) && scene.environment->map == previous.environmentMap->source) {
        flat.environmentMap = previous.environmentMap;
    }
    flat.nodes = packNodes(bvh);
    flat.stackLevels = stackLevelsOf(bvh);
    flat.features = primitives.spheres.empty() ? 0U : kFeatureSpheres;
    findLargeTriangles(flat, scene, primitives);
    flattenMaterials(flat, scene, findColored(scene));
    for (const MeshInstance& instance : scene.instances) {
        flat.features |= flat.materialFeatures[scene.meshes[instance.mesh].material];
    }
    for (const Sphere& sphere : scene.spheres) {
        flat.features |= flat.materialFeatures[sphere.material];
    }
    if ((flat.features & kFeaturePrincipled) != 0) {
        static const std::vector<uvec4> albedos = makeAlbedoTable();  // .4 s of CPU time
        flat.albedos = albedos;
    }
    if ((flat.features & kFeatureSheen) != 0) {
        static const std::vector<uvec4> sheen = makeSheenTable();
        flat.albedos.insert(flat.albedos.end(), sheen.begin(), sheen.end());
    }
    if ((flat.features & kFeatureAnisotropy) != 0) {
        static const std::vector<uvec4> anisotropic = makeAnisotropicAlbedoTable();  // .1 s of CPU time
        flat.albedos.resize(kFirstAnisotropicAlbedo);
        flat.albedos.insert(flat.albedos.end(), anisotropic.begin(), anisotropic.end());
    }
    pushShading(flat, primitives);
    const std::vector<std::uint32_t> recordOf = pushRecords(flat, scene, primitives, bvh);
    pushSharedRecords(flat, scene, primitives, bvh);
    pushInstances(flat, primitives, bvh);
    addLights(flat, scene, primitives, recordOf);
    markOtherRecords(flat, bvh.order, recordOf);
    addCaustics(flat, scene, primitives);
    flat.features |= mayLampsBeInMedia(flat) ? kFeatureLampsInMedia : 0U;
    return flat;
}

FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens)
{
    const bool perspective = camera.kind == Camera::Kind::Perspective;
    const float halfHeight = perspective ? std::tan(0.5F * camera.yfov) : camera.halfHeight;
    const float halfWidth = perspective ? halfHeight * aspectRatio : std::copysign(halfHeight * aspectRatio, camera.halfWidth);
    return {camera.position,
            camera.right * halfWidth,
            camera.up * halfHeight,
            camera.forward,
            perspective ? kPerspective : kOrthographic,
            camera.right * lens.radius,
            camera.up * lens.radius,
            1.0F / lens.focalDistance};
}

}  // namespace glim
