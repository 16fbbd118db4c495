// The primitives that the BVH holds and rays hit.
#pragma once

#include "host/flatten/placed_spheres.hpp"
#include "host/scene/share_meshes.hpp"

namespace glim {

// A mesh that instances share, in a space of its own: the mesh's, with `center` as origin.
struct SharedMesh {
    std::uint32_t mesh = 0;
    std::uint32_t firstId = 0;  // of its triangles, in its own space: after the scene's primitives and the shared meshes before it
    glm::dvec3 center{0.0};
    std::vector<Triangle> triangles;
    std::vector<glm::uvec3> vertexIndices;  // as in Primitives
    std::vector<bool> hasAlpha;             // by triangle
};

// A motion of a shared mesh: a point p of its space is where the motion takes p + pivot, relative to the scene's origin.
struct PlacedMotion {
    Motion keys;
    glm::dvec3 pivot{0.0};

    bool operator==(const PlacedMotion&) const = default;
};

// An instance of a shared mesh. A point p of that mesh's space is at linear * p + translation, relative to the scene's origin.
struct Placement {
    std::uint32_t instance = 0;  // of the scene
    std::uint32_t sharedMesh = 0;
    glm::dmat3 linear{1.0};
    glm::dvec3 translation{0.0};
    std::optional<PlacedMotion> motion;  // while the shutter is open; the place above is that of the frame's time
};

// The triangles of all instances that share no mesh, one instance after the other, then the scene's spheres, then the points or lines of
// clouds, again one instance after the other. A primitive's id counts through all.
struct Primitives {
    std::vector<Triangle> triangles;
    PlacedSpheres spheres;
    std::vector<std::uint32_t> firstTriangles;  // by instance, then the number of all triangles
    std::vector<SharedMesh> sharedMeshes;
    std::vector<Placement> placements;

    // What shading reads of vertices; all are empty if no mesh has any of it. Vertex 0 is that of triangles without attributes.
    std::vector<glm::uvec3> vertexIndices;  // by triangle
    std::vector<glm::vec3> vertexNormals;   // unit, or 0 where the mesh is flat
    // Each is by vertex, or empty if no material needs it.
    std::vector<glm::vec4> vertexUvs;       // set 0, set 1
    std::vector<glm::vec4> vertexTangents;  // unit, w the sign of the bitangent; 0 where there is none
    std::vector<glm::vec4> vertexColors;

    std::vector<bool> hasAlpha;  // by primitive: neither opaque nor transparent all over; empty if no primitive is

    std::vector<Message> warnings;  // one line each: what was dropped or replaced

    std::size_t count() const { return triangles.size() + spheres.size(); }
    std::uint64_t computeTriangleCount() const;  // those of shared meshes once for each instance
    std::uint32_t findInstance(std::uint32_t triangle) const;
};

// Meshes are shared as scene/share_meshes.hpp says. Triangles without area and primitives that are transparent all over are dropped;
// normals that are zero or not finite are replaced by the face normal; lights in the plane of another surface are lifted (lift_lights.hpp).
Primitives makePrimitives(const Scene& scene, std::uint64_t maxFlatTriangles = kMaxFlatTriangles);

// What two scenes have in common: all primitives, all but the placements of shared meshes, or maybe nothing.
enum class Same { Nothing, AllButPlacements, Everything };

// `primitives`: those of `before`. Scenes that share their meshes' array may have more in common than nothing.
Same compareSurfaces(const Scene& before, const Primitives& primitives, const Scene& scene);

// Places the shared meshes as the scene does, which has all but the placements in common with that of the primitives.
void placeSharedMeshes(const Scene& scene, Primitives& primitives);

}  // namespace glim
