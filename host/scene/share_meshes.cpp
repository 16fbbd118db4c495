#include "host/scene/share_meshes.hpp"

#include <algorithm>
#include <functional>

namespace glim {
namespace {

// What an instance takes on the device, in triangles.
constexpr std::uint64_t kTrianglesOfInstance = 3;

struct Candidate {
    std::size_t mesh;
    std::uint64_t saved;  // triangles
};

}  // namespace

std::vector<bool> chooseSharedMeshes(std::span<const MeshUse> uses, std::uint64_t maxFlatTriangles)
{
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const std::uint64_t flat = uses[i].instances * uses[i].triangles;
        const std::uint64_t shared = uses[i].triangles + uses[i].instances * kTrianglesOfInstance;
        if (!uses[i].emits && flat > shared) {
            candidates.push_back({i, flat - shared});
        }
    }
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::saved);
    std::uint64_t triangles = countTriangles(uses);
    std::vector<bool> shared(uses.size());
    std::transform(uses.begin(), uses.end(), shared.begin(), [](const MeshUse& use) { return use.moves; });
    for (const Candidate& candidate : candidates) {
        if (triangles <= maxFlatTriangles) {
            break;
        }
        shared[candidate.mesh] = true;
        triangles -= candidate.saved;
    }
    return shared;
}

std::vector<MeshUse> countMeshUses(const Scene& scene)
{
    std::vector<MeshUse> uses;
    for (const Mesh& mesh : scene.meshes) {
        uses.push_back({0, mesh.indices.size() / 3, scene.materials[mesh.material].emission != glm::vec3(0.0F), false});
    }
    for (const MeshInstance& instance : scene.instances) {
        ++uses[instance.mesh].instances;
        uses[instance.mesh].moves = uses[instance.mesh].moves || instance.motion != nullptr;
    }
    return uses;
}

std::uint64_t countTriangles(std::span<const MeshUse> uses)
{
    std::uint64_t triangles = 0;
    for (const MeshUse& use : uses) {
        triangles += use.instances * use.triangles;
    }
    return triangles;
}

}  // namespace glim
