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
    // The linear part for cameras and lights, which have a direction and no size: without the scales of nodes that flatten.
    glm::dmat3 worldFromAxes{1.0};
    bool visible = true;  // KHR_node_visibility, which leaves cameras as they are
};

// In document order, parents first. Checks that the nodes form trees.
std::vector<PlacedNode> placeNodes(const GltfFile& file, const LoadOptions& options, Warnings& warnings);

// Of a node's 16 numbers. Refuses another last row than 0 0 0 1.
glm::dmat4 readMatrix(const GltfFile& file, std::size_t node, const std::vector<double>& values);

// Where `nodes` stand in the world, visible or not. The nodes form trees.
std::vector<glm::dmat4> worldFromNodes(const GltfFile& file, const std::vector<std::size_t>& nodes);

// Whether what has a size becomes a plane, a line or a point. A scale of 0 is a common way to hide a node.
bool isFlattening(const PlacedNode& node);

// The linear part of a node that carries a shape, and the axes of one that carries a camera or a light. Refuse a singular one.
glm::dmat3 readLinear(const GltfFile& file, const PlacedNode& node);
glm::dmat3 readAxes(const GltfFile& file, const PlacedNode& node);

}  // namespace glim
