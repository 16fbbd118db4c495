// Flattens the node hierarchy of one scene: where each node stands in the world.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/warnings.hpp"

#include <glm/glm.hpp>

namespace glim {

struct PlacedNode {
    std::size_t index;
    glm::dmat4 worldFromNode;  // affine
};

// In document order, parents first. Checks that the nodes form trees.
std::vector<PlacedNode> placeNodes(const GltfFile& file, const LoadOptions& options, Warnings& warnings);

// Where `nodes` stand in the world, visible or not. The nodes form trees.
std::vector<glm::dmat4> worldFromNodes(const GltfFile& file, const std::vector<std::size_t>& nodes);

// The linear part of a node that carries a shape, camera or light. Refuses a singular one.
glm::dmat3 readLinear(const GltfFile& file, const PlacedNode& node);

}  // namespace glim
