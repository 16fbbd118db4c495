// Meshes made in memory. Vertices that triangles share have equal bits.
#pragma once

#include "host/flatten/primitives.hpp"

namespace glim {

using Triangles = std::vector<Triangle>;

// Without a scene: ids are indices into `triangles`, then into `spheres`.
Primitives makeTestPrimitives(const Triangles& triangles, const std::vector<Sphere>& spheres = {});

// Adds a mesh and an instance of it. `normals`: none, or three per triangle.
void addMesh(Scene& scene, const Triangles& triangles, std::uint32_t material = 0, const std::vector<glm::vec3>& normals = {});
// Of a mesh of the scene, scaled and then rotated by `angle` about a slanted axis.
void addInstance(Scene& scene, std::uint32_t mesh, const glm::dvec3& at, double angle, const glm::dvec3& scale);

// The vertices, three per triangle: on the unit sphere, the normals there.
std::vector<glm::vec3> listVertices(const Triangles& triangles);

// 20 * 4^subdivisions triangles, vertices on the unit sphere, fronts outwards.
Triangles icosphere(int subdivisions);

// The closed surface of [-1, 1]^3: its sides are 8 * rings strips as thin as 1e-6, its caps fans with a sliver.
Triangles sliverBox(int rings);

// Height field over [-10, 10]^2, 2 * cells^2 triangles, up is +y.
Triangles terrain(int cells);

// Vertices within `size` of a random point of [-1, 1]^3 along each axis.
Triangles randomTriangles(std::size_t count, float size, std::uint32_t seed);

std::vector<Sphere> randomSpheres(std::size_t count, float largestRadius, std::uint32_t seed);

// Strips a fifth wide, of two triangles each, from near one corner of [-1, 1]^3 to near the opposite one, and 40 small triangles
// for each of them. The tree of such a scene is one of pieces.
Triangles strips(std::size_t count, std::uint32_t seed);

// The closed surface of a prism around the unit sphere, 4 long along (1, 1, 1), of `sides` sides of two triangles each; its ends are fans
// of `rings` rings. The tree of such a mesh is one of pieces.
Triangles aslantPrism(int sides, int rings);

// `count` copies of the triangle (-1,-1,0) (1,-1,0) (0,1,0).
Triangles coincidentTriangles(std::size_t count);

// Along +x, each triangle starts where the one before ends and is `ratio` times its length.
Triangles growingLine(std::size_t count, float first, double ratio);

// (vertex + shift) * scale: one value for equal vertices, so that shared ones stay shared.
Triangles placed(Triangles mesh, float scale, float shift);

// One mesh of one white material, and spheres of the same.
Scene makeTestScene(const Triangles& mesh, const std::vector<Sphere>& spheres = {});

}  // namespace glim
