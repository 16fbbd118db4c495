// Chooses the meshes that are stored once, however many instances they have.
#pragma once

#include "host/scene/scene.hpp"

#include <span>

namespace glim {

// A scene of at most so many triangles, counted once for each instance, shares no mesh: rays are faster through one tree. The limit must
// not depend on the machine, because a shared mesh rounds otherwise.
inline constexpr std::uint64_t kMaxFlatTriangles = std::uint64_t{1} << 22U;

struct MeshUse {
    std::uint64_t instances = 0;
    std::uint64_t triangles = 0;  // of the mesh
    bool emits = false;
    bool moves = false;  // some instance, while the shutter is open
};

// One entry for each mesh. Shares as few as the limit allows, and those first that save most triangles. Meshes that emit are never shared:
// each of their triangles is a light of its own, whatever instance it is of. Those that move are: rays are moved in their place.
std::vector<bool> chooseSharedMeshes(std::span<const MeshUse> uses, std::uint64_t maxFlatTriangles = kMaxFlatTriangles);

std::vector<MeshUse> countMeshUses(const Scene& scene);

// Triangles, counted once for each instance.
std::uint64_t countTriangles(std::span<const MeshUse> uses);

}  // namespace glim
