// Tangents for normal maps of meshes that come without: MikkTSpace (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008), which
// glTF 2.0 asks for (3.7.2.1), with no angular threshold. As in glTF's tools, the sign w is that for a v that grows downwards. This is
// glim's own code, since Debian has no package of Mikkelsen's, and since the bits of pictures depend on it.
#pragma once

#include "host/scene/scene.hpp"

#include <span>

namespace glim {

// One tangent per corner, three per triangle. xyz is a unit vector perpendicular to the corner's normal, along rising u; the bitangent is
// cross(normal, xyz) * w and goes along falling v, which is upwards in a glTF texture. `indices` has three entries per triangle, the others
// one per vertex; what corners have in common is found by their values, not by their indices. Normals of zero length or not finite give way
// to the face normal; without any, the mesh is flat. Always finite.
std::vector<glm::vec4> makeTangents(std::span<const std::uint32_t> indices, std::span<const glm::dvec3> positions,
                                    std::span<const glm::dvec3> normals, std::span<const glm::vec2> uvs);

// Fills mesh.tangents from uv1 or uv0, which must not be empty. A vertex whose corners differ in tangent is split: one of them keeps the
// index, vertices for the others are appended. Returns how many triangles have a corner whose tangent the uv do not determine: it is an
// arbitrary one perpendicular to the normal.
std::size_t addTangents(Mesh& mesh, bool secondUvSet);

}  // namespace glim
