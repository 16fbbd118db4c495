// glTF primitives as indexed triangle lists in the space of their node.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <glm/glm.hpp>

#include <cstdint>

namespace glim {

struct MeshPart {
    std::string name;  // of the mesh, with the primitive's number where there are several; may be empty
    std::vector<glm::dvec3> positions;  // finite
    std::vector<glm::dvec3> normals;    // empty, or one per position, of any length and possibly not finite
    std::vector<std::uint32_t> corners; // three per triangle, counter-clockwise from the front, below positions.size()
    int material = -1;
};

// Points, lines and primitives without positions are left out and said so.
std::vector<MeshPart> readMesh(const GltfFile& file, std::size_t mesh, std::vector<std::string>& notices);

}  // namespace glim
