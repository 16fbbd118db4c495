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
    std::vector<Needs> needs;             // by material of the file, then of the default one
    std::optional<std::size_t> variant;   // whose materials the meshes have
    std::array<bool, 2> hasRadii{false};  // whether all points and all lines have a radius that was chosen
    SharedVector<Mesh> meshes;
    std::vector<std::vector<std::uint32_t>> meshesOf;  // by use
    std::vector<std::array<glm::dvec3, 8>> corners;    // of a box around each mesh; empty until a scene with very many triangles asks
    Warnings warnings;
};

// Asks whether a scene fits into memory before any of it is read, by the counts of accessors alone. Refuses one that needs more memory
// than the machine has, or than the process may take.
void checkSize(const GltfFile& file, const std::vector<PlacedNode>& nodes);

// Fills origin, meshes, instances and spheres of `scene`, whose materials are the file's, followed by the default one. Refuses
// coordinates that do not fit float32. `read`: what the scene before has read, or nothing yet.
void readGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, ReadMeshes& read, Warnings& warnings);

// Refuses a scene with nothing to draw. What animations have flattened counts as drawn.
void requireShapes(const GltfFile& file, const Scene& scene);

// What glTF calls a primitive of a mesh is a mesh here. Each is named after the file's mesh, with a number if that has several primitives.
// The default material's index follows the file's last one. Primitives without positions are left out, each with a warning.
std::vector<Mesh> readMeshes(const GltfFile& file, std::size_t mesh, const MeshPose& pose, Warnings& warnings);

// EXT_mesh_gpu_instancing: how many instances of its mesh the node has, without reading them.
std::uint64_t countInstances(const GltfFile& file, std::size_t node);

// The same where the file's own bytes hold none of its attributes, else 0.
std::uint64_t countUnbackedInstances(const GltfFile& file, std::size_t node);

// Where the node's instances stand, in the node's own space: one identity without the extension. Refuses attributes of different counts and
// values that are not finite.
std::vector<glm::dmat4> readInstanceTransforms(const GltfFile& file, std::size_t node);

}  // namespace glim
