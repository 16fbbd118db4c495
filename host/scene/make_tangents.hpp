// Tangents of meshes whose file has none, as MikkTSpace defines them: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), and
// the reference implementation that glTF 2.0, section 3.7.2.1, refers to.
#pragma once

#include "host/scene/scene.hpp"
#include "host/scene/warnings.hpp"

namespace glim {

// One tangent per corner (three per triangle): xyz is unit and perpendicular to the normal; w is the sign of the bitangent cross(n, t) w,
// which points against v, upwards in the picture. Normals may be none: then each triangle's own counts. Corners are taken for the same
// vertex if position, normal and texture coordinates are equal, whatever the indices say.
std::vector<glm::vec4> makeTangents(const Mesh& mesh, const std::vector<glm::vec2>& uv);

// Gives tangents to every mesh that is drawn with a normal map and has none, by the texture coordinates of that map. A vertex whose
// corners differ is split.
void giveTangents(Scene& scene, Warnings& warnings);

}  // namespace glim
