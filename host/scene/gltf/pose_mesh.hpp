// Poses the meshes of a file: reads morph targets, skins and joints, and bends a mesh by them.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/warnings.hpp"

#include <glm/glm.hpp>

namespace glim {

struct MeshPose {
    std::optional<std::size_t> skin;
    std::vector<glm::dmat4> worldFromBind;  // by joint of the skin
    std::vector<double> weights;            // of morph targets; empty if all are 0

    bool operator==(const MeshPose&) const = default;
};

// Of the primitive that has the most: others may lack some.
std::size_t countMorphTargets(const tinygltf::Mesh& mesh);

// The weights of the node's morph targets: its own, else its mesh's; empty if all are 0.
std::vector<double> readMorphWeights(const GltfFile& file, std::size_t node);

// The matrices of a skin's joints, which go from the pose that the skin was bound in to the world.
std::vector<glm::dmat4> placeJoints(const GltfFile& file, std::size_t skin);

// Morphs and skins what was read from a primitive of `source`. A skinned mesh is in world coordinates afterwards.
void poseMesh(const GltfFile& file, const tinygltf::Mesh& source, std::size_t primitive, const MeshPose& pose, const std::string& place,
              Mesh& mesh, Warnings& warnings);

}  // namespace glim
