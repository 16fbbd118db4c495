#include "host/scene/gltf/check_size.hpp"

#include "host/memory.hpp"
#include "host/scene/gltf/read_instancing.hpp"
#include "host/scene/share_meshes.hpp"
#include "host/text.hpp"

#include <algorithm>

namespace glim {
namespace {

// What they take at least while the tree is built, measured with flat triangles without any attribute (tests/bench/README.md).
constexpr std::uint64_t kBytesPerTriangle = 200, kBytesPerVertex = 24, kBytesPerInstance = 400;

bool mayEmit(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    if (primitive.material < 0) {
        return false;
    }
    const std::vector<double>& factor = file.model.materials[static_cast<std::size_t>(primitive.material)].emissiveFactor;
    return std::any_of(factor.begin(), factor.end(), [](double channel) { return channel > 0.0; });
}

// Its triangles and vertices, if it is drawn.
struct PrimitiveSize {
    std::uint64_t triangles = 0, vertices = 0;
};

PrimitiveSize sizeOf(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end() || primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        return {};
    }
    const std::uint64_t vertices = file.model.accessors[static_cast<std::size_t>(position->second)].count;
    const std::uint64_t order = primitive.indices >= 0 ? file.model.accessors[static_cast<std::size_t>(primitive.indices)].count : vertices;
    return {primitive.mode == TINYGLTF_MODE_TRIANGLES ? order / 3 : order, vertices};
}

}  // namespace

void checkSize(const GltfFile& file, const std::vector<PlacedNode>& nodes)
{
    std::vector<std::uint64_t> instancesOf(file.model.meshes.size(), 0);
    for (const PlacedNode& node : nodes) {
        if (const int mesh = file.model.nodes[node.index].mesh; mesh >= 0) {
            instancesOf[static_cast<std::size_t>(mesh)] += countInstances(file, node.index);
        }
    }
    std::vector<MeshUse> uses;  // by primitive
    std::uint64_t vertices = 0, instances = 0;
    for (std::size_t mesh = 0; mesh < instancesOf.size(); ++mesh) {
        for (const tinygltf::Primitive& primitive : file.model.meshes[mesh].primitives) {
            const PrimitiveSize size = sizeOf(file, primitive);
            uses.push_back({instancesOf[mesh], size.triangles, mayEmit(file, primitive)});
            vertices += instancesOf[mesh] > 0 ? size.vertices : 0;
            instances += instancesOf[mesh];
        }
    }
    const std::vector<bool> shared = chooseSharedMeshes(uses);
    std::uint64_t stored = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        stored += shared[i] ? uses[i].triangles : uses[i].instances * uses[i].triangles;
    }
    const std::uint64_t needed = stored * kBytesPerTriangle + vertices * kBytesPerVertex + instances * kBytesPerInstance;
    if (const std::uint64_t available = availableBytes(); needed > available) {
        refuse(file, "the scene has " + counted(countTriangles(uses), "triangle") + " in " + counted(instances, "instance") + "; " +
                         std::to_string(stored) + " of them have to be stored, which takes at least " + std::to_string(needed >> 20U) +
                         " MiB; expected at most the " + std::to_string(available >> 20U) + " MiB that the process may take");
    }
}

}  // namespace glim
