#include "host/scene/make_tangents.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <unordered_map>

namespace glim {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

// Position, normal and texture coordinates of a corner, by their bits.
using CornerKey = std::array<std::uint64_t, 8>;

struct CornerHash {
    std::size_t operator()(const CornerKey& key) const
    {
        std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a, a word at a time
        for (const std::uint64_t word : key) {
            hash = (hash ^ word) * 1099511628211ULL;
            hash ^= hash >> 29U;
        }
        return static_cast<std::size_t>(hash);
    }
};

std::uint64_t bitsOf(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }  // -0 is 0

glm::dvec3 unitOrZero(const glm::dvec3& v)
{
    const double length = glm::length(v);
    return length > 0.0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

// The part of v in the plane of the unit vector n, as a unit vector or zero.
glm::dvec3 inPlane(const glm::dvec3& v, const glm::dvec3& n) { return unitOrZero(v - n * glm::dot(n, v)); }

glm::dvec3 anyPerpendicular(const glm::dvec3& n)
{
    const glm::dvec3 axis = std::abs(n.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(axis - n * glm::dot(n, axis));
}

class TangentMaker {
public:
    TangentMaker(const Mesh& mesh, const std::vector<glm::vec2>& uv)
        : mesh_(mesh),
          uv_(uv),
          corners_(mesh.indices.size())
    {}

    std::vector<glm::vec4> make()
    {
        weld();
        measureTriangles();
        findNeighbours();
        groupOf_.assign(corners_, kNone);
        for (std::uint32_t corner = 0; corner < corners_; ++corner) {
            if (groupOf_[corner] == kNone && faces_[corner / 3].usable()) {
                grow(corner);
            }
        }
        return collect();
    }

private:
    struct Face {
        glm::dvec3 tangent{0.0};  // unit, along growing u
        bool preserving = false;  // u and v turn like the triangle's corners
        bool mapped = false;      // its texture coordinates span an area
        bool flat = false;        // two of its corners are in one place
        bool usable() const { return mapped && !flat; }
    };

    glm::dvec3 position(std::size_t corner) const { return mesh_.positions[mesh_.indices[corner]]; }

    void weld()
    {
        std::unordered_map<CornerKey, std::uint32_t, CornerHash> known;
        known.reserve(corners_);
        for (std::size_t corner = 0; corner < corners_; ++corner) {
            const std::uint32_t index = mesh_.indices[corner];
            const std::size_t first = corner - corner % 3;
            glm::dvec3 n = mesh_.normals.empty() ? glm::dvec3(0.0) : unitOrZero(mesh_.normals[index]);
            if (n == glm::dvec3(0.0)) {
                n = unitOrZero(glm::cross(position(first + 1) - position(first), position(first + 2) - position(first)));
            }
            const glm::dvec3 p = position(corner);
            const glm::dvec2 t(uv_[index]);
            const CornerKey key{bitsOf(p.x), bitsOf(p.y), bitsOf(p.z), bitsOf(n.x), bitsOf(n.y), bitsOf(n.z), bitsOf(t.x), bitsOf(t.y)};
            const auto [entry, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(normals_.size()));
            if (fresh) {
                normals_.push_back(n);
            }
            vertexOf_.push_back(entry->second);
        }
    }

    void measureTriangles()
    {
        for (std::size_t at = 0; at < corners_; at += 3) {
            const glm::dvec3 a = position(at), b = position(at + 1), c = position(at + 2);
            const glm::dvec2 origin(uv_[mesh_.indices[at]]);
            const glm::dvec2 s = glm::dvec2(uv_[mesh_.indices[at + 1]]) - origin, t = glm::dvec2(uv_[mesh_.indices[at + 2]]) - origin;
            const double area = s.x * t.y - s.y * t.x;
            Face face;
            face.preserving = area > 0.0;
            face.flat = a == b || b == c || a == c;
            face.tangent = unitOrZero((area > 0.0 ? 1.0 : -1.0) * ((b - a) * t.y - (c - a) * s.y));
            const glm::dvec3 bitangent = unitOrZero((c - a) * s.x - (b - a) * t.x);
            face.mapped = area != 0.0 && face.tangent != glm::dvec3(0.0) && bitangent != glm::dvec3(0.0);
            faces_.push_back(face);
        }
    }

    // Edge k of a triangle leads from its corner k to the next one; two triangles are neighbours if they run along it in opposite
    // directions.
    void findNeighbours()
    {
        struct Edge {
            std::uint32_t low, high, corner;
            bool forwards;
        };
        std::vector<Edge> edges;
        for (std::uint32_t corner = 0; corner < corners_; ++corner) {
            if (faces_[corner / 3].flat) {
                continue;
            }
            const std::uint32_t from = vertexOf_[corner], to = vertexOf_[next(corner)];
            edges.push_back({std::min(from, to), std::max(from, to), corner, from < to});
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.corner) < std::tie(b.low, b.high, b.corner);
        });
        neighbour_.assign(corners_, kNone);
        for (std::size_t i = 0; i < edges.size(); ++i) {
            for (std::size_t j = i + 1; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j) {
                if (neighbour_[edges[i].corner] == kNone && neighbour_[edges[j].corner] == kNone && edges[i].forwards != edges[j].forwards) {
                    neighbour_[edges[i].corner] = edges[j].corner / 3;
                    neighbour_[edges[j].corner] = edges[i].corner / 3;
                }
            }
        }
    }

    static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static std::uint32_t previous(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

    // Collects the triangles around a vertex that are reached over shared edges and are mapped with the same orientation. Those without an
    // area in the texture join whichever comes first.
    void grow(std::uint32_t start)
    {
        const auto group = static_cast<std::uint32_t>(sums_.size());
        const bool preserving = faces_[start / 3].preserving;
        sums_.emplace_back(0.0);
        preserving_.push_back(preserving);
        std::vector<std::uint32_t> open{start};
        while (!open.empty()) {
            const std::uint32_t corner = open.back();
            open.pop_back();
            Face& face = faces_[corner / 3];
            const std::uint32_t first = corner - corner % 3;
            if (!face.mapped && groupOf_[first] == kNone && groupOf_[first + 1] == kNone && groupOf_[first + 2] == kNone) {
                face.preserving = preserving;
            }
            if (groupOf_[corner] != kNone || face.preserving != preserving) {
                continue;
            }
            groupOf_[corner] = group;
            addTo(sums_[group], corner);
            for (const std::uint32_t across : {neighbour_[corner], neighbour_[previous(corner)]}) {
                for (std::uint32_t k = 0; across != kNone && k < 3; ++k) {
                    if (vertexOf_[3 * across + k] == vertexOf_[corner]) {
                        open.push_back(3 * across + k);
                    }
                }
            }
        }
    }

    // Weighted by the corner's angle, as seen along the normal.
    void addTo(glm::dvec3& sum, std::uint32_t corner) const
    {
        if (!faces_[corner / 3].usable()) {
            return;
        }
        const glm::dvec3& n = normals_[vertexOf_[corner]];
        const glm::dvec3 a = inPlane(position(next(corner)) - position(corner), n), b = inPlane(position(previous(corner)) - position(corner), n);
        sum += inPlane(faces_[corner / 3].tangent, n) * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    }

    // A corner without a group takes the tangent of another corner of its vertex, or any.
    std::vector<glm::vec4> collect() const
    {
        std::vector<std::uint32_t> groupAt(normals_.size(), kNone);
        for (std::size_t corner = 0; corner < corners_; ++corner) {
            if (groupOf_[corner] != kNone && groupAt[vertexOf_[corner]] == kNone) {
                groupAt[vertexOf_[corner]] = groupOf_[corner];
            }
        }
        std::vector<glm::vec4> tangents;
        for (std::size_t corner = 0; corner < corners_; ++corner) {
            const glm::dvec3 n = normals_[vertexOf_[corner]];
            const std::uint32_t group = groupOf_[corner] != kNone ? groupOf_[corner] : groupAt[vertexOf_[corner]];
            glm::dvec3 tangent = group == kNone ? glm::dvec3(0.0) : unitOrZero(sums_[group]);
            tangent = tangent == glm::dvec3(0.0) ? anyPerpendicular(n) : tangent;
            // Texture coordinates grow downwards, so the sign is the opposite of that with v upwards.
            tangents.emplace_back(glm::vec3(tangent), group != kNone && preserving_[group] ? -1.0F : 1.0F);
        }
        return tangents;
    }

    const Mesh& mesh_;
    const std::vector<glm::vec2>& uv_;
    std::size_t corners_;
    std::vector<glm::dvec3> normals_;       // by welded vertex; unit or zero
    std::vector<std::uint32_t> vertexOf_;   // by corner
    std::vector<Face> faces_;
    std::vector<std::uint32_t> neighbour_;  // triangle across the edge that begins at the corner
    std::vector<std::uint32_t> groupOf_;    // by corner
    std::vector<glm::dvec3> sums_;          // by group
    std::vector<bool> preserving_;          // by group
};

template <class Value>
void duplicate(std::vector<Value>& values, std::size_t index)
{
    if (!values.empty()) {
        const Value value = values[index];
        values.push_back(value);
    }
}

// Gives each corner its tangent; the first one that a vertex meets stays with it.
void setTangents(Mesh& mesh, const std::vector<glm::vec4>& corners)
{
    const auto original = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<bool> taken(original, false);
    std::map<std::pair<std::uint32_t, std::array<float, 4>>, std::uint32_t> copies;
    mesh.tangents.assign(original, glm::vec4(0.0F));
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        std::uint32_t& index = mesh.indices[corner];
        const glm::vec4& tangent = corners[corner];
        if (!taken[index]) {
            taken[index] = true;
            mesh.tangents[index] = tangent;
        }
        if (mesh.tangents[index] == tangent) {
            continue;
        }
        const auto [copy, fresh] = copies.try_emplace({index, {tangent.x, tangent.y, tangent.z, tangent.w}}, mesh.positions.size());
        if (fresh) {
            duplicate(mesh.positions, index);
            duplicate(mesh.normals, index);
            duplicate(mesh.uv0, index);
            duplicate(mesh.uv1, index);
            duplicate(mesh.colors, index);
            mesh.tangents.push_back(tangent);
        }
        index = copy->second;
    }
}

}  // namespace

std::vector<glm::vec4> makeTangents(const Mesh& mesh, const std::vector<glm::vec2>& uv) { return TangentMaker(mesh, uv).make(); }

void giveTangents(Scene& scene, Warnings& warnings)
{
    for (Mesh& mesh : scene.meshes) {
        const std::optional<Texture>& map = scene.materials[mesh.material].normalTexture;
        // Flat meshes have the tangents of their faces, whatever the file says.
        if (!map || (!mesh.tangents.empty() && !mesh.normals.empty())) {
            continue;
        }
        const std::vector<glm::vec2>& uv = map->uvSet == 0 ? mesh.uv0 : mesh.uv1;
        if (uv.empty()) {
            warnings.add("normal maps without texture coordinates are ignored", mesh.name);
            mesh.tangents.clear();
            continue;
        }
        setTangents(mesh, makeTangents(mesh, uv));
    }
}

}  // namespace glim
