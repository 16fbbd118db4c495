// Reads the shapes of placed nodes: meshes, instances and spheres.
#pragma once

#include "host/scene/gltf/place_nodes.hpp"
#include "host/scene/gltf/pose_mesh.hpp"
#include "host/shared_vector.hpp"

#include <array>

namespace glim {

// The meshes that a scene of the file has, and what they were read for. The next scene that asks for the same has the same ones.
struct ReadMeshes {
    struct Use {
        std::size_t mesh;  // of the file
        MeshPose pose;

        bool operator==(const Use&) const = default;
    };
    // What a material asks of its meshes.
    struct Needs {
        std::array<std::uint32_t, 2> uvSets;
        std::optional<std::uint32_t> uvSetOfTangents;

        bool operator==(const Needs&) const = default;
    };

    std::vector<Use> uses;
    std::vector<Needs> needs;  // by material of the file, then of the default one
    SharedVector<Mesh> meshes;
    std::vector<std::vector<std::uint32_t>> meshesOf;  // by use
    std::vector<std::array<glm::dvec3, 8>> corners;    // of a box around each mesh; empty until a scene with very many triangles asks
    Warnings warnings;
};

// Fills origin, meshes, instances and spheres of `scene`, whose materials are the file's, followed by the default one. Refuses
// coordinates that do not fit float32. `read`: what the scene before has read, or nothing yet.
void readGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, ReadMeshes& read, Warnings& warnings);

// Refuses a scene with nothing to draw. What animations have flattened counts as drawn.
void requireShapes(const GltfFile& file, const Scene& scene);

}  // namespace glim
