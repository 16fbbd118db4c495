#include "host/scene/make_tangents.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace glim {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kRounding = 1e-9;  // the length below which a sum of a few unit vectors is taken for zero

// Of equal numbers, the same bits.
std::uint64_t bitsOf(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }
std::uint64_t bitsOf(float a, float b)
{
    return static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(a + 0.0F)) << 32U | std::bit_cast<std::uint32_t>(b + 0.0F);
}

template <std::size_t N>
std::size_t computeHash(const std::array<std::uint64_t, N>& words)
{
    std::uint64_t hash = 0;
    for (const std::uint64_t word : words) {
        hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
        hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash);
}

// For each of `count` items the first one with an equal key: an array of words.
template <class KeyOf>
std::vector<std::uint32_t> findFirstEqual(std::size_t count, const KeyOf& keyOf)
{
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * count + 1), kNone);
    std::vector<std::uint32_t> firsts(count);
    for (std::uint32_t item = 0; item < count; ++item) {
        const auto key = keyOf(item);
        std::size_t slot = computeHash(key) & (slots.size() - 1);
        while (slots[slot] != kNone && keyOf(slots[slot]) != key) {
            slot = (slot + 1) & (slots.size() - 1);
        }
        if (slots[slot] == kNone) {
            slots[slot] = item;
        }
        firsts[item] = slots[slot];
    }
    return firsts;
}

// Zero if the vector is zero or not finite.
glm::dvec3 unitOrZero(const glm::dvec3& vector)
{
    const glm::dvec3 scaled = vector / std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    const double length = glm::length(scaled);
    return length > 0.0 ? scaled / length : glm::dvec3(0.0);
}

// The direction of a unit vector as seen along a unit normal; zero if they are parallel.
glm::dvec3 projectUnit(const glm::dvec3& vector, const glm::dvec3& normal)
{
    const glm::dvec3 projected = vector - normal * glm::dot(normal, vector);
    const double length = glm::length(projected);
    return length > kRounding ? projected / length : glm::dvec3(0.0);
}

glm::dvec3 anyPerpendicular(const glm::dvec3& normal)
{
    const glm::dvec3 size = glm::abs(normal);
    const int least = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    glm::dvec3 axis(0.0);
    axis[least] = 1.0;
    return glm::normalize(glm::cross(normal, axis));
}

// Corner 3 * t + i is vertex i of triangle t.
std::uint32_t nextCorner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
std::uint32_t previousCorner(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

class Corners {
public:
    Corners(std::span<const std::uint32_t> indices, std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
            std::span<const glm::vec2> uvs)
        : indices_(indices),
          positions_(positions),
          uvs_(uvs)
    {
        unitNormals_.reserve(normals.size());
        for (const glm::dvec3& normal : normals) {
            unitNormals_.push_back(unitOrZero(normal));
        }
    }

    std::size_t count() const { return indices_.size(); }
    const glm::dvec3& position(std::uint32_t corner) const { return positions_[indices_[corner]]; }
    const glm::vec2& uv(std::uint32_t corner) const { return uvs_[indices_[corner]]; }

    // Always a unit vector.
    glm::dvec3 normal(std::uint32_t corner) const
    {
        if (!unitNormals_.empty() && unitNormals_[indices_[corner]] != glm::dvec3(0.0)) {
            return unitNormals_[indices_[corner]];
        }
        const std::uint32_t first = corner - corner % 3;
        const glm::dvec3 face = unitOrZero(glm::cross(position(first + 1) - position(first), position(first + 2) - position(first)));
        return face == glm::dvec3(0.0) ? glm::dvec3(0, 0, 1) : face;
    }

    std::array<std::uint64_t, 7> key(std::uint32_t corner) const
    {
        const glm::dvec3 p = position(corner);
        const glm::dvec3 n = normal(corner);
        return {bitsOf(p.x), bitsOf(p.y), bitsOf(p.z), bitsOf(n.x), bitsOf(n.y), bitsOf(n.z), bitsOf(uv(corner).x, uv(corner).y)};
    }

    // The angle at a corner between its edges as seen along the normal.
    double angle(std::uint32_t corner, const glm::dvec3& normal) const
    {
        const glm::dvec3 in = projectUnit(unitOrZero(position(previousCorner(corner)) - position(corner)), normal);
        const glm::dvec3 out = projectUnit(unitOrZero(position(nextCorner(corner)) - position(corner)), normal);
        return std::acos(std::clamp(glm::dot(in, out), -1.0, 1.0));
    }

private:
    std::span<const std::uint32_t> indices_;
    std::span<const glm::dvec3> positions_;
    std::span<const glm::vec2> uvs_;
    std::vector<glm::dvec3> unitNormals_;  // by vertex; zero where there is none
};

struct Face {
    glm::dvec3 tangent{0.0};            // unit; zero if there is no uv area
    bool preservesOrientation = false;  // uv go around the triangle from the u axis to the v axis
    bool collapsed = false;             // two corners have one position: its edges connect nothing
};

Face makeFace(const Corners& corners, std::uint32_t first)
{
    const glm::dvec3& a = corners.position(first);
    const glm::dvec3& b = corners.position(first + 1);
    const glm::dvec3& c = corners.position(first + 2);
    Face face;
    face.collapsed = a == b || b == c || c == a;
    const glm::dvec2 toB = glm::dvec2(corners.uv(first + 1)) - glm::dvec2(corners.uv(first));
    const glm::dvec2 toC = glm::dvec2(corners.uv(first + 2)) - glm::dvec2(corners.uv(first));
    const double area = toB.x * toC.y - toC.x * toB.y;
    face.preservesOrientation = area > 0.0;
    if (face.collapsed || !std::isfinite(area) || area == 0.0) {
        return face;
    }
    const double sign = face.preservesOrientation ? 1.0 : -1.0;
    const glm::dvec3 tangent = unitOrZero(sign * ((b - a) * toC.y - (c - a) * toB.y));
    const glm::dvec3 bitangent = unitOrZero(sign * ((c - a) * toB.x - (b - a) * toC.x));
    if (bitangent != glm::dvec3(0.0)) {
        face.tangent = tangent;
    }
    return face;
}

class TangentMaker {
public:
    explicit TangentMaker(Corners corners)
        : corners_(std::move(corners)),
          vertices_(findFirstEqual(corners_.count(), [&](std::uint32_t corner) { return corners_.key(corner); })),
          opposites_(corners_.count(), kNone),
          grouped_(corners_.count(), false),
          tangents_(corners_.count(), glm::vec4(0.0F))
    {
        faces_.reserve(corners_.count() / 3);
        for (std::uint32_t first = 0; first < corners_.count(); first += 3) {
            faces_.push_back(makeFace(corners_, first));
        }
    }

    void make()
    {
        pairEdges();
        for (std::uint32_t corner = 0; corner < corners_.count(); ++corner) {
            if (!grouped_[corner] && faces_[corner / 3].tangent != glm::dvec3(0.0)) {
                gatherGroup(corner);
                setTangents();
            }
        }
        fillGaps();
    }

    std::vector<glm::vec4> takeTangents() { return std::move(tangents_); }
    std::size_t undetermined() const { return undetermined_; }

private:
    struct Edge {
        std::uint64_t ends;   // the smaller vertex first
        std::uint64_t order;  // bit 32: from the larger to the smaller; below, the corner where it starts
    };

    // Two triangles that run along an edge in opposite directions are neighbours: of more, the first ones of either direction, the second
    // ones, and so on.
    void pairEdges()
    {
        const std::vector<Edge> edges = sortEdges();
        for (std::size_t begin = 0; begin < edges.size();) {
            std::size_t middle = begin;
            while (middle < edges.size() && edges[middle].ends == edges[begin].ends && edges[middle].order < kBackward) {
                ++middle;
            }
            std::size_t end = middle;
            while (end < edges.size() && edges[end].ends == edges[begin].ends) {
                ++end;
            }
            for (std::size_t i = 0; i < std::min(middle - begin, end - middle); ++i) {
                const auto forward = static_cast<std::uint32_t>(edges[begin + i].order);
                const auto backward = static_cast<std::uint32_t>(edges[middle + i].order);
                opposites_[forward] = backward;
                opposites_[backward] = forward;
            }
            begin = end;
        }
    }

    std::vector<Edge> sortEdges() const
    {
        std::vector<Edge> edges;
        edges.reserve(corners_.count());
        for (std::uint32_t corner = 0; corner < corners_.count(); ++corner) {
            if (!faces_[corner / 3].collapsed) {
                const std::uint64_t from = vertices_[corner], to = vertices_[nextCorner(corner)];
                edges.push_back({std::min(from, to) << 32U | std::max(from, to), corner + (from > to ? kBackward : 0)});
            }
        }
        std::sort(edges.begin(), edges.end(),
                  [](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : a.order < b.order; });
        return edges;
    }

    // The corner at the same vertex across the edge that starts, or ends, at a corner.
    std::uint32_t acrossOutgoing(std::uint32_t corner) const
    {
        return opposites_[corner] == kNone ? kNone : nextCorner(opposites_[corner]);
    }
    std::uint32_t acrossIncoming(std::uint32_t corner) const { return opposites_[previousCorner(corner)]; }

    // All corners that neighbours connect to this one around its vertex, as far as uv go around their triangles in the same sense.
    void gatherGroup(std::uint32_t corner)
    {
        group_.clear();
        const bool preservesOrientation = faces_[corner / 3].preservesOrientation;
        join(corner, preservesOrientation);
        for (std::uint32_t at = acrossOutgoing(corner); at != kNone && join(at, preservesOrientation);) {
            at = acrossOutgoing(at);
        }
        for (std::uint32_t at = acrossIncoming(corner); at != kNone && join(at, preservesOrientation);) {
            at = acrossIncoming(at);
        }
    }

    bool join(std::uint32_t corner, bool preservesOrientation)
    {
        Face& face = faces_[corner / 3];
        const std::uint32_t first = corner - corner % 3;
        if (face.tangent == glm::dvec3(0.0) && !grouped_[first] && !grouped_[first + 1] && !grouped_[first + 2]) {
            face.preservesOrientation = preservesOrientation;  // without uv area, the first group decides
        }
        if (grouped_[corner] || face.preservesOrientation != preservesOrientation) {
            return false;
        }
        grouped_[corner] = true;
        group_.push_back(corner);
        return true;
    }

    // The mean of the triangles' tangents in the plane of the normal, weighted by angle. Where it is zero each keeps its own.
    void setTangents()
    {
        const glm::dvec3 normal = corners_.normal(group_.front());
        glm::dvec3 sum(0.0);
        for (const std::uint32_t corner : group_) {
            sum += corners_.angle(corner, normal) * projectUnit(faces_[corner / 3].tangent, normal);
        }
        const bool cancelled = glm::length(sum) < kRounding;
        for (const std::uint32_t corner : group_) {
            const glm::dvec3 tangent = cancelled ? projectUnit(faces_[corner / 3].tangent, normal) : glm::normalize(sum);
            tangents_[corner] = glm::vec4(tangent, handedness(corner));
        }
    }

    // From tangent to bitangent is counter-clockwise seen from the front, if from rising u to falling v is.
    float handedness(std::uint32_t corner) const { return faces_[corner / 3].preservesOrientation ? -1.0F : 1.0F; }

    bool isSet(std::uint32_t corner) const { return glm::vec3(tangents_[corner]) != glm::vec3(0.0F); }

    // Corners without a tangent take that of the first corner that has one at their vertex. (mikktspace.c does so for collapsed triangles
    // alone; others without uv area that join no group it gives the x axis, whatever the normal.)
    void fillGaps()
    {
        std::vector<std::uint32_t> lenders(corners_.count(), kNone);  // by vertex
        for (std::uint32_t corner = 0; corner < corners_.count(); ++corner) {
            if (lenders[vertices_[corner]] == kNone && isSet(corner)) {
                lenders[vertices_[corner]] = corner;
            }
        }
        std::uint32_t last = kNone;
        for (std::uint32_t corner = 0; corner < corners_.count(); ++corner) {
            if (isSet(corner)) {
                continue;
            }
            if (const std::uint32_t lender = lenders[vertices_[corner]]; lender != kNone) {
                tangents_[corner] = tangents_[lender];
                continue;
            }
            tangents_[corner] = glm::vec4(anyPerpendicular(corners_.normal(corner)), handedness(corner));
            undetermined_ += last == corner / 3 ? 0 : 1;
            last = corner / 3;
        }
    }

    static constexpr std::uint64_t kBackward = 1ULL << 32U;

    Corners corners_;
    std::vector<std::uint32_t> vertices_;   // by corner: the first corner with equal position, normal and uv
    std::vector<std::uint32_t> opposites_;  // by corner, for the edge that starts there: where the neighbour's edge starts
    std::vector<Face> faces_;
    std::vector<bool> grouped_;         // by corner
    std::vector<std::uint32_t> group_;  // corners at one vertex
    std::vector<glm::vec4> tangents_;   // by corner; xyz zero: not known yet
    std::size_t undetermined_ = 0;      // triangles
};

template <class T>
void duplicate(std::vector<T>& attributes, std::uint32_t vertex)
{
    if (!attributes.empty()) {
        attributes.push_back(T(attributes[vertex]));
    }
}

std::uint32_t splitVertex(Mesh& mesh, std::uint32_t vertex)
{
    duplicate(mesh.positions, vertex);
    duplicate(mesh.normals, vertex);
    duplicate(mesh.tangents, vertex);
    duplicate(mesh.uv0, vertex);
    duplicate(mesh.uv1, vertex);
    duplicate(mesh.colors, vertex);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// `tangents`: by corner. Of the corners of a vertex, the first one and those like it keep it.
void splitByTangent(Mesh& mesh, const std::vector<glm::vec4>& tangents)
{
    const std::vector<std::uint32_t> firsts = findFirstEqual(tangents.size(), [&](std::uint32_t corner) {
        const glm::vec4& t = tangents[corner];
        return std::array<std::uint64_t, 3>{mesh.indices[corner], bitsOf(t.x, t.y), bitsOf(t.z, t.w)};
    });
    mesh.tangents.assign(mesh.positions.size(), glm::vec4(0.0F));
    for (std::uint32_t corner = 0; corner < tangents.size(); ++corner) {
        std::uint32_t& vertex = mesh.indices[corner];
        if (firsts[corner] != corner) {
            vertex = mesh.indices[firsts[corner]];
            continue;
        }
        if (mesh.tangents[vertex] != glm::vec4(0.0F)) {
            vertex = splitVertex(mesh, vertex);
        }
        mesh.tangents[vertex] = tangents[corner];
    }
    std::replace(mesh.tangents.begin(), mesh.tangents.end(), glm::vec4(0.0F), glm::vec4(1, 0, 0, 1));  // of no triangle
}

}  // namespace

std::vector<glm::vec4> makeTangents(std::span<const std::uint32_t> indices, std::span<const glm::dvec3> positions,
                                    std::span<const glm::dvec3> normals, std::span<const glm::vec2> uvs)
{
    TangentMaker maker(Corners(indices, positions, normals, uvs));
    maker.make();
    return maker.takeTangents();
}

std::size_t addTangents(Mesh& mesh, bool secondUvSet)
{
    TangentMaker maker(Corners(mesh.indices, mesh.positions, mesh.normals, secondUvSet ? mesh.uv1 : mesh.uv0));
    maker.make();
    splitByTangent(mesh, maker.takeTangents());
    return maker.undetermined();
}

}  // namespace glim
