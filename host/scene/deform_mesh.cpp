#include "host/scene/deform_mesh.hpp"

#include <utility>

namespace glim {
namespace {

// Zero, and what is not finite, stay as they are.
glm::dvec3 unitOrSame(const glm::dvec3& vector)
{
    const double length = glm::length(vector);
    return length > 0.0 ? vector / length : vector;
}

// The determinant times the inverse transpose: it exists even where the inverse does not.
glm::dmat3 cofactors(const glm::dmat3& m) { return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])}; }

glm::dmat4 blend(const Influences& influences, std::size_t vertex, std::span<const glm::dmat4> worldFromBind)
{
    glm::dmat4 sum(0.0);
    for (std::size_t i = vertex * influences.perVertex; i < (vertex + 1) * influences.perVertex; ++i) {
        if (influences.weights[i] > 0.0) {
            sum += influences.weights[i] * worldFromBind[influences.joints[i]];
        }
    }
    return sum;
}

}  // namespace

void morphMesh(Mesh& mesh, std::span<const MorphTarget> targets)
{
    const auto sum = [targets](glm::dvec3 value, std::size_t vertex, std::vector<glm::dvec3> MorphTarget::*deltas) {
        for (const MorphTarget& target : targets) {
            if (!(target.*deltas).empty()) {
                value += target.weight * (target.*deltas)[vertex];
            }
        }
        return value;
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = sum(mesh.positions[i], i, &MorphTarget::positions);
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        mesh.normals[i] = unitOrSame(sum(mesh.normals[i], i, &MorphTarget::normals));
    }
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        const glm::dvec3 tangent = sum(glm::dvec3(mesh.tangents[i]), i, &MorphTarget::tangents);
        mesh.tangents[i] = glm::vec4(unitOrSame(tangent), mesh.tangents[i].w);
    }
}

void skinMesh(Mesh& mesh, const Influences& influences, std::span<const glm::dmat4> worldFromBind)
{
    std::vector<bool> mirrored(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dmat4 matrix = blend(influences, i, worldFromBind);
        const glm::dmat3 linear(matrix);
        mirrored[i] = glm::determinant(linear) < 0.0;
        const double side = mirrored[i] ? -1.0 : 1.0;
        mesh.positions[i] = linear * mesh.positions[i] + glm::dvec3(matrix[3]);
        if (!mesh.normals.empty()) {
            mesh.normals[i] = unitOrSame(side * (cofactors(linear) * mesh.normals[i]));
        }
        if (!mesh.tangents.empty()) {
            // cross(normal, tangent) changes its sign when the matrix mirrors.
            mesh.tangents[i] = glm::vec4(unitOrSame(linear * glm::dvec3(mesh.tangents[i])), side * static_cast<double>(mesh.tangents[i].w));
        }
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::uint32_t* corners = &mesh.indices[i];
        if (mirrored[corners[0]] && mirrored[corners[1]] && mirrored[corners[2]]) {
            std::swap(corners[1], corners[2]);
        }
    }
}

}  // namespace glim
