// A mesh as an instance places it in the world.
#pragma once

#include "host/scene/scene.hpp"

#include <array>

namespace glim {

// Three vertices in world space, float32 relative to the scene's origin, counter-clockwise seen from the front. Vertices that triangles
// share have equal bits, on which watertightness depends.
struct Triangle {
    glm::vec3 vertices[3];
};

// Not normalised: its length is twice the area.
glm::dvec3 faceNormal(const Triangle& triangle);

// Takes positions of a mesh to where an instance has them: the one place where vertices become float32.
struct Placing {
    glm::dmat3 linear;
    glm::dvec3 translation;

    Placing(const glm::dmat3& by, const glm::dvec3& then)
        : linear(by),
          translation(then)
    {}
    Placing(const Scene& scene, const MeshInstance& instance)
        // Moved close to zero first, so that far from the world's origin nothing is rounded away.
        : Placing(glm::dmat3(instance.worldFromMesh), glm::dvec3(instance.worldFromMesh[3]) - scene.origin)
    {}
    glm::vec3 operator()(const glm::dvec3& position) const { return glm::vec3(linear * position + translation); }
};

class PlacedMesh {
public:
    PlacedMesh(const Scene& scene, const MeshInstance& instance);
    PlacedMesh(const Mesh& mesh, const Placing& place);

    std::size_t triangleCount() const { return mesh_->indices.size() / 3; }
    // Indices of the mesh's vertices. If the instance mirrors, two are swapped, so that the front stays the front.
    std::array<std::uint32_t, 3> corners(std::size_t triangle) const;
    Triangle triangle(std::size_t triangle) const;
    const std::vector<glm::vec3>& positions() const { return positions_; }

private:
    const Mesh* mesh_;
    std::size_t second_;                // which of a triangle's indices comes second
    std::vector<glm::vec3> positions_;  // by vertex
};

// Of the points or lines of a cloud, in the world. An uneven scale counts as the even one that keeps volumes.
float computePointRadius(const Scene& scene, const MeshInstance& instance);

// The bounds of everything that has a surface, was not added to the scene and is no ground: flat and several times as long as all that is
// not flat. 2 m of each axis where nothing is.
struct WorldBox {
    glm::vec3 low, high;  // relative to the scene's origin
};

WorldBox computeWorldBox(const Scene& scene);

// How far any of that reaches from the vertical axis through `center`; of large scenes, how far their box does.
double computeRadius(const Scene& scene, const glm::dvec3& center);

}  // namespace glim
