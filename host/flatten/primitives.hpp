// The primitives that the BVH holds and rays hit.
#pragma once

#include "host/scene/placed_mesh.hpp"

namespace glim {

// The triangles of all instances, one instance after the other, then the scene's spheres. A primitive's id counts through both.
struct Primitives {
    std::vector<Triangle> triangles;
    std::vector<Sphere> spheres;
    std::vector<std::uint32_t> firstTriangles;  // by instance, then the number of all triangles

    // Shading normals, unit; both are empty if no mesh has any. Vertex 0 has the normal 0; a triangle without normals has it three times.
    std::vector<glm::uvec3> vertexIndices;  // by triangle
    std::vector<glm::vec3> vertexNormals;

    std::vector<std::string> warnings;  // one line each: what was dropped or replaced

    std::size_t count() const { return triangles.size() + spheres.size(); }
    std::uint32_t instanceOf(std::uint32_t triangle) const;
};

// Triangles without area are dropped; normals that are zero or not finite are replaced by the face normal.
Primitives makePrimitives(const Scene& scene);

}  // namespace glim
