#include "host/flatten/primitives.hpp"

#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr std::uint32_t kNotYet = std::numeric_limits<std::uint32_t>::max();

// The inverse transpose up to a positive factor: the cofactors, with the determinant's sign.
glm::dmat3 computeWorldFromNormal(const glm::dmat3& linear)
{
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

using Words = std::array<std::uint32_t, 3>;

std::size_t hashOf(const Words& words)
{
    std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a, a word at a time; the multiplication's high bits are the good ones
    for (const std::uint32_t word : words) {
        hash = (hash ^ word) * 1099511628211ULL;
    }
    return static_cast<std::size_t>(hash ^ hash >> 32U);
}

class PrimitiveMaker {
public:
    explicit PrimitiveMaker(const Scene& scene)
        : scene_(scene)
    {
        std::size_t count = 0;
        for (const MeshInstance& instance : scene.instances) {
            count += scene.meshes[instance.mesh].indices.size() / 3;
            smooth_ = smooth_ || !scene.meshes[instance.mesh].normals.empty();
        }
        made_.triangles.reserve(count);
        made_.vertexIndices.reserve(smooth_ ? count : 0);
        if (smooth_) {
            made_.vertexNormals.emplace_back(0.0F);
        }
    }

    Primitives make()
    {
        for (const MeshInstance& instance : scene_.instances) {
            made_.firstTriangles.push_back(static_cast<std::uint32_t>(made_.triangles.size()));
            addInstance(instance);
        }
        made_.firstTriangles.push_back(static_cast<std::uint32_t>(made_.triangles.size()));
        made_.spheres = scene_.spheres;
        if (flatTriangles_ > 0) {
            made_.warnings.push_back("left out " + counted(flatTriangles_, "triangle") + " of zero area");
        }
        if (badNormals_ > 0) {
            made_.warnings.push_back("used the face normal in place of " + counted(badNormals_, "normal") +
                                     " of zero length or not finite");
        }
        return std::move(made_);
    }

private:
    void addInstance(const MeshInstance& instance)
    {
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const PlacedMesh placed(scene_, instance);
        worldFromNormal_ = computeWorldFromNormal(glm::dmat3(instance.worldFromMesh));
        vertexOf_.assign(mesh.normals.size(), kNotYet);
        // Without indices, triangles side by side repeat each other's normals. A table of half-empty slots finds them.
        const bool unindexed = !mesh.normals.empty() && mesh.indices.size() <= mesh.positions.size();
        slots_.assign(unindexed ? std::bit_ceil(2 * mesh.indices.size()) : 0, kNotYet);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            const glm::dvec3 normal = faceNormal(triangle);
            if (normal == glm::dvec3(0.0)) {
                ++flatTriangles_;
                continue;
            }
            made_.triangles.push_back(triangle);
            if (smooth_) {
                made_.vertexIndices.push_back(mesh.normals.empty() ? glm::uvec3(0) : addVertices(mesh, placed.corners(i), normal));
            }
        }
    }

    glm::uvec3 addVertices(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners, const glm::dvec3& faceNormal)
    {
        glm::uvec3 vertices;
        for (int v = 0; v < 3; ++v) {
            std::uint32_t& vertex = vertexOf_[corners[static_cast<std::size_t>(v)]];
            if (vertex == kNotYet) {
                const glm::dvec3 normal = worldFromNormal_ * mesh.normals[corners[static_cast<std::size_t>(v)]];
                const double length = glm::length(normal);
                if (!std::isfinite(length) || !(length > 0.0)) {
                    vertices[v] = addVertex(glm::vec3(glm::normalize(faceNormal)));  // of this triangle alone
                    ++badNormals_;
                    continue;
                }
                vertex = slots_.empty() ? addVertex(glm::vec3(normal / length)) : findOrAddVertex(glm::vec3(normal / length));
            }
            vertices[v] = vertex;
        }
        return vertices;
    }

    std::uint32_t findOrAddVertex(const glm::vec3& normal)
    {
        const auto words = std::bit_cast<Words>(normal);
        std::size_t slot = hashOf(words) & (slots_.size() - 1);
        while (slots_[slot] != kNotYet && std::bit_cast<Words>(made_.vertexNormals[slots_[slot]]) != words) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        if (slots_[slot] == kNotYet) {
            slots_[slot] = addVertex(normal);
        }
        return slots_[slot];
    }

    std::uint32_t addVertex(const glm::vec3& normal)
    {
        made_.vertexNormals.push_back(normal);
        return static_cast<std::uint32_t>(made_.vertexNormals.size() - 1);
    }

    const Scene& scene_;
    bool smooth_ = false;  // some mesh has normals
    Primitives made_;
    glm::dmat3 worldFromNormal_{1.0};
    std::vector<std::uint32_t> vertexOf_;  // by vertex of the mesh
    std::vector<std::uint32_t> slots_;     // of the hash table, by a normal's hash; empty for a mesh with indices
    std::size_t flatTriangles_ = 0, badNormals_ = 0;
};

}  // namespace

std::uint32_t Primitives::instanceOf(std::uint32_t triangle) const
{
    const auto after = std::upper_bound(firstTriangles.begin(), firstTriangles.end(), triangle);
    return static_cast<std::uint32_t>(after - firstTriangles.begin() - 1);
}

Primitives makePrimitives(const Scene& scene) { return PrimitiveMaker(scene).make(); }

}  // namespace glim
