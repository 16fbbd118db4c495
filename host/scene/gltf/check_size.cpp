#include "host/scene/gltf/read_geometry.hpp"

#include "host/memory.hpp"
#include "host/scene/gltf/read_accessor.hpp"
#include "host/scene/share_meshes.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <compare>
#include <set>

namespace glim {
namespace {

// What they take at least while the tree is built, measured with flat triangles and points without any attribute (tests/bench/README.md).
// A light is a point that emits.
constexpr std::uint64_t kBytesPerTriangle = 200, kBytesPerVertex = 24, kBytesPerInstance = 400, kBytesPerPoint = 90, kBytesPerLight = 200;

// How many elements an instance, and a matrix of a skin, count as where the file's own bytes do not hold them.
constexpr std::uint64_t kElementsPerInstance = 16, kElementsPerMatrix = 4;

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

// Targets of weight 0 are not read.
std::uint64_t countUnbacked(const GltfFile& file, const tinygltf::Primitive& primitive, const std::vector<double>& weights)
{
    const auto count = [&file](int accessor) { return countUnbacked(file, static_cast<std::size_t>(accessor)); };
    std::uint64_t sum = primitive.indices >= 0 ? count(primitive.indices) : 0;
    for (const auto& [name, accessor] : primitive.attributes) {
        sum += count(accessor);
    }
    for (std::size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i) {
        for (const auto& [name, accessor] : primitive.targets[i]) {
            sum += weights[i] == 0.0 ? 0 : count(accessor);
        }
    }
    return sum;
}

// A mesh is read once for each skin and each set of weights.
struct Reading {
    std::size_t mesh;
    int skin;
    std::vector<double> weights;

    auto operator<=>(const Reading&) const = default;
};

std::uint64_t countUnbacked(const GltfFile& file, const Reading& reading)
{
    std::uint64_t sum = 0;
    for (const tinygltf::Primitive& primitive : file.model.meshes[reading.mesh].primitives) {
        sum += countUnbacked(file, primitive, reading.weights);
    }
    const std::optional<std::size_t> matrices =
        reading.skin >= 0 ? file.skins[static_cast<std::size_t>(reading.skin)].inverseBindMatrices : std::nullopt;
    return sum + (matrices ? kElementsPerMatrix * countUnbacked(file, *matrices) : 0);
}

}  // namespace

void checkSize(const GltfFile& file, const std::vector<PlacedNode>& nodes)
{
    std::vector<std::uint64_t> instancesOf(file.model.meshes.size(), 0), readingsOf(instancesOf);
    std::set<Reading> readings;
    std::uint64_t unbacked = 0;
    for (const PlacedNode& node : nodes) {
        const tinygltf::Node& source = file.model.nodes[node.index];
        if (source.mesh < 0 || !node.visible) {
            continue;
        }
        const auto mesh = static_cast<std::size_t>(source.mesh);
        instancesOf[mesh] += countInstances(file, node.index);
        unbacked += kElementsPerInstance * countUnbackedInstances(file, node.index);
        if (const auto [reading, isNew] = readings.insert({mesh, source.skin, readMorphWeights(file, node.index)}); isNew) {
            ++readingsOf[mesh];
            unbacked += countUnbacked(file, *reading);
        }
    }
    checkUnbacked(file, "its meshes, and its instances as " + std::to_string(kElementsPerInstance) + " each,", unbacked);
    std::vector<MeshUse> uses;  // by primitive
    std::uint64_t vertices = 0, points = 0, lights = 0, instances = 0;
    for (std::size_t mesh = 0; mesh < instancesOf.size(); ++mesh) {
        for (const tinygltf::Primitive& primitive : file.model.meshes[mesh].primitives) {
            const PrimitiveSize size = sizeOf(file, primitive);
            uses.push_back({instancesOf[mesh], size.triangles, mayEmit(file, primitive)});
            vertices += readingsOf[mesh] * size.vertices;
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
