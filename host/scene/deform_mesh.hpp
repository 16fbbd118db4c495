// Bends meshes: morph targets and skins (glTF 2.0, sections 3.7.2.2 and 3.7.3). A mesh is morphed first, then skinned.
#pragma once

#include "host/scene/scene.hpp"

#include <span>

namespace glim {

// What a morph target adds to a mesh's attributes, times its weight: one for each vertex, or none.
struct MorphTarget {
    double weight = 0.0;
    std::vector<glm::dvec3> positions, normals, tangents;
};

// Attributes that the mesh lacks stay away, whatever the targets have.
void morphMesh(Mesh& mesh, std::span<const MorphTarget> targets);

// The joints that each vertex follows, by vertex, with weights. A joint of weight 0 need not exist.
struct Influences {
    std::size_t perVertex = 0;
    std::vector<std::uint32_t> joints{};
    std::vector<double> weights{};  // from 0
};

// Moves each vertex by the weighted sum of its joints' matrices, which go from the pose that the mesh was bound in to the world. Normals go
// by the inverse transpose of that sum. Where it mirrors a triangle, front stays front.
void skinMesh(Mesh& mesh, const Influences& influences, std::span<const glm::dmat4> worldFromBind);

}  // namespace glim
