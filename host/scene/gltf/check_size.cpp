#include "host/scene/gltf/read_geometry.hpp"

#include "host/memory.hpp"
#include "host/scene/share_meshes.hpp"
#include "host/text.hpp"

#include <algorithm>

namespace glim {
namespace {

// What they take at least while the tree is built, measured with flat triangles and points without any attribute (tests/bench/README.md).
// A light is a point that emits.
constexpr std::uint64_t kBytesPerTriangle = 200, kBytesPerVertex = 24, kBytesPerInstance = 400, kBytesPerPoint = 90, kBytesPerLight = 200;

// Elements of accessors without a bufferView cost a file nothing, and any number of primitives may use the same ones. So many are never too
// many; beyond, files that leave out zeros, as of morph targets, have vertices that are there. An instance counts as many vertices.
constexpr std::uint64_t kFewUnbacked = std::uint64_t{1} << 22U, kUnbackedPerByte = 16, kVerticesPerInstance = 16;

bool mayEmit(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    if (primitive.material < 0) {
        return false;
    }
    const std::vector<double>& factor = file.model.materials[static_cast<std::size_t>(primitive.material)].emissiveFactor;
    return std::any_of(factor.begin(), factor.end(), [](double channel) { return channel > 0.0; });
}

// Its triangles, or points or lines, and its vertices, if it is drawn.
struct PrimitiveSize {
    std::uint64_t triangles = 0, points = 0, vertices = 0;
};

PrimitiveSize sizeOf(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
        return {};
    }
    const std::uint64_t vertices = file.model.accessors[static_cast<std::size_t>(position->second)].count;
    const std::uint64_t order = primitive.indices >= 0 ? file.model.accessors[static_cast<std::size_t>(primitive.indices)].count : vertices;
    switch (primitive.mode) {
    case TINYGLTF_MODE_LINE: return {0, order / 2, vertices};
    case TINYGLTF_MODE_POINTS:
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP: return {0, order, vertices};
    case TINYGLTF_MODE_TRIANGLES: return {order / 3, 0, vertices};
    default: return {order, 0, vertices};
    }
}

std::uint64_t countUnbacked(const GltfFile& file, int accessor)
{
    const tinygltf::Accessor& source = file.model.accessors[static_cast<std::size_t>(accessor)];
    return source.bufferView < 0 ? source.count : 0;
}

std::uint64_t countUnbacked(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    std::uint64_t count = primitive.indices >= 0 ? countUnbacked(file, primitive.indices) : 0;
    for (const auto& [name, accessor] : primitive.attributes) {
        count += countUnbacked(file, accessor);
    }
    for (const auto& target : primitive.targets) {
        for (const auto& [name, accessor] : target) {
            count += countUnbacked(file, accessor);
        }
    }
    return count;
}

// Refuses a file that would take far more memory than it has bytes, before anything is read.
void checkUnbacked(const GltfFile& file, const std::vector<std::uint64_t>& instancesOf, std::uint64_t unbackedInstances)
{
    std::uint64_t unbacked = kVerticesPerInstance * unbackedInstances;
    for (std::size_t mesh = 0; mesh < instancesOf.size(); ++mesh) {
        for (const tinygltf::Primitive& primitive : file.model.meshes[mesh].primitives) {
            unbacked += instancesOf[mesh] > 0 ? countUnbacked(file, primitive) : 0;
        }
    }
    if (const std::uint64_t most = kFewUnbacked + kUnbackedPerByte * countBytes(file.buffers); unbacked > most) {
        refuse(file, MessageId::TooLarge,
               {"its primitives and instances use ", part::value(std::to_string(unbacked)),
                " elements of accessors without a bufferView, an instance as ", std::to_string(kVerticesPerInstance), "; expected ",
                part::expected("at most " + std::to_string(most) + " in a file of this size")});
    }
}

}  // namespace

void checkSize(const GltfFile& file, const std::vector<PlacedNode>& nodes)
{
    std::vector<std::uint64_t> instancesOf(file.model.meshes.size(), 0);
    std::uint64_t unbackedInstances = 0;
    for (const PlacedNode& node : nodes) {
        if (const int mesh = file.model.nodes[node.index].mesh; mesh >= 0 && node.visible) {
            instancesOf[static_cast<std::size_t>(mesh)] += countInstances(file, node.index);
            unbackedInstances += countUnbackedInstances(file, node.index);
        }
    }
    checkUnbacked(file, instancesOf, unbackedInstances);
    std::vector<MeshUse> uses;  // by primitive
    std::uint64_t vertices = 0, points = 0, lights = 0, instances = 0;
    for (std::size_t mesh = 0; mesh < instancesOf.size(); ++mesh) {
        for (const tinygltf::Primitive& primitive : file.model.meshes[mesh].primitives) {
            const PrimitiveSize size = sizeOf(file, primitive);
            uses.push_back({instancesOf[mesh], size.triangles, mayEmit(file, primitive)});
            vertices += instancesOf[mesh] > 0 ? size.vertices : 0;
            points += instancesOf[mesh] * size.points;
            lights += mayEmit(file, primitive) && primitive.mode == TINYGLTF_MODE_POINTS ? instancesOf[mesh] * size.points : 0;
            instances += instancesOf[mesh];
        }
    }
    const std::vector<bool> shared = chooseSharedMeshes(uses);
    std::uint64_t stored = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        stored += shared[i] ? uses[i].triangles : uses[i].instances * uses[i].triangles;
    }
    const std::uint64_t needed = stored * kBytesPerTriangle + points * kBytesPerPoint + lights * kBytesPerLight +
                                 vertices * kBytesPerVertex + instances * kBytesPerInstance;
    if (const std::uint64_t available = availableBytes(); needed > available) {
        refuse(file, MessageId::OutOfMemory,
               {"the scene has ", counted(countTriangles(uses), "triangle"), " and ", std::to_string(points), " points and lines", " in ",
                counted(instances, "instance"), "; ", std::to_string(stored + points), " of them have to be stored, which takes at least ",
                part::value(std::to_string(needed >> 20U)), " MiB; expected ",
                part::expected("at most the " + std::to_string(available >> 20U) + " MiB that the process may take")});
    }
}

}  // namespace glim
