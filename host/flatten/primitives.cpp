#include "host/flatten/primitives.hpp"

#include "host/flatten/classify_alpha.hpp"
#include "host/flatten/flatten_materials.hpp"
#include "host/flatten/lift_lights.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>

namespace glim {
namespace {

constexpr std::uint32_t kNotYet = std::numeric_limits<std::uint32_t>::max();

// The inverse transpose up to a positive factor: the cofactors, with the determinant's sign.
glm::dmat3 computeWorldFromNormal(const glm::dmat3& linear)
{
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

// What shading reads of a vertex.
struct Vertex {
    glm::vec3 normal{0.0F};
    glm::vec4 uv{0.0F}, tangent{0.0F}, color{1.0F};
};

using Words = std::array<std::uint32_t, 15>;

std::size_t hashWords(const Words& words)
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
        for (const MeshInstance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[instance.mesh];
            if (mesh.isCloud) {
                continue;
            }
            smooth_ = smooth_ || !mesh.normals.empty();
            mapped_ = mapped_ || isTextured(scene_.materials[mesh.material]);
            tangents_ = tangents_ || !mesh.tangents.empty();
            colored_ = colored_ || !mesh.colors.empty();
        }
        if (smooth_ || mapped_ || tangents_ || colored_) {
            addVertex(Vertex());
        }
    }

    Primitives make(std::uint64_t maxFlatTriangles)
    {
        const std::vector<bool> shared = chooseSharedMeshes(countMeshUses(scene_), maxFlatTriangles);
        for (const MeshInstance& instance : scene_.instances) {
            made_.firstTriangles.push_back(static_cast<std::uint32_t>(made_.triangles.size()));
            if (!shared[instance.mesh]) {
                const PlacedMesh placed(scene_, instance);
                addTriangles(scene_.meshes[instance.mesh], placed, glm::dmat3(instance.worldFromMesh));
            }
        }
        made_.firstTriangles.push_back(static_cast<std::uint32_t>(made_.triangles.size()));
        shareMeshes(shared);
        placeSharedMeshes(scene_, made_);
        addSpheres();
        if (std::find(made_.hasAlpha.begin(), made_.hasAlpha.end(), true) == made_.hasAlpha.end()) {
            made_.hasAlpha.clear();
        }
        if (flatTriangles_ > 0) {
            made_.warnings.push_back(
                {MessageId::FlatTriangle, {"left out ", part::value(counted(flatTriangles_, "triangle")), " of zero area"}});
        }
        if (badNormals_ > 0) {
            made_.warnings.push_back(
                {MessageId::BadNormal,
                 {"used the face normal in place of ", part::value(counted(badNormals_, "normal")), " of zero length or not finite"}});
        }
        return std::move(made_);
    }

private:
    template <class Add>
    void addPrimitive(Coverage coverage, const Add& add)
    {
        if (coverage != Coverage::Transparent) {
            made_.hasAlpha.push_back(coverage == Coverage::Mixed);
            add();
        }
    }

    void addSpheres()
    {
        made_.spheres = PlacedSpheres(scene_);
        std::vector<std::uint32_t> kept;
        for (std::uint32_t i = 0; i < made_.spheres.size(); ++i) {
            const PlacedSphere sphere = made_.spheres[i];
            addPrimitive(alpha_.classify(sphere.material, made_.spheres.computeColor(sphere).a), [&] { kept.push_back(i); });
        }
        if (kept.size() < made_.spheres.size()) {
            made_.spheres.select(std::move(kept));
        }
    }

    void addTriangles(const Mesh& mesh, const PlacedMesh& placed, const glm::dmat3& worldFromMesh)
    {
        worldFromMesh_ = worldFromMesh;
        worldFromNormal_ = computeWorldFromNormal(worldFromMesh_);
        vertexOf_.assign(mesh.positions.size(), kNotYet);
        const bool attributes =
            !mesh.normals.empty() || !mesh.colors.empty() || !mesh.tangents.empty() || (mapped_ && !(mesh.uv0.empty() && mesh.uv1.empty()));
        // Without indices, triangles side by side repeat each other's vertices. A table of half-empty slots finds them.
        const bool unindexed = attributes && mesh.indices.size() <= mesh.positions.size();
        slots_.assign(unindexed ? std::bit_ceil(2 * mesh.indices.size()) : 0, kNotYet);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            const glm::dvec3 normal = faceNormal(triangle);
            if (normal == glm::dvec3(0.0)) {
                ++flatTriangles_;
                continue;
            }
            addPrimitive(alpha_.classify(mesh, placed.corners(i)), [&] {
                made_.triangles.push_back(triangle);
                if (!made_.vertexNormals.empty()) {
                    made_.vertexIndices.push_back(attributes ? addVertices(mesh, placed.corners(i), normal) : glm::uvec3(0));
                }
            });
        }
    }

    void shareMeshes(const std::vector<bool>& shared)
    {
        std::vector<std::uint32_t> indexOf(scene_.meshes.size(), kNotYet);
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const MeshInstance& instance = scene_.instances[i];
            if (!shared[instance.mesh]) {
                continue;
            }
            std::uint32_t& index = indexOf[instance.mesh];
            if (index == kNotYet) {
                index = static_cast<std::uint32_t>(made_.sharedMeshes.size());
                made_.sharedMeshes.push_back(shareMesh(instance.mesh));
            }
            if (!made_.sharedMeshes[index].triangles.empty()) {
                made_.placements.push_back({i, index});
            }
        }
    }

    // Adds the triangles at the end and takes them away.
    SharedMesh shareMesh(std::uint32_t id)
    {
        const Mesh& mesh = scene_.meshes[id];
        SharedMesh shared;
        shared.mesh = id;
        shared.center = centerOf(mesh);
        const std::size_t triangles = made_.triangles.size(), indices = made_.vertexIndices.size();
        addTriangles(mesh, PlacedMesh(mesh, Placing(glm::dmat3(1.0), -shared.center)), glm::dmat3(1.0));
        const auto takeFrom = [](auto& values, std::size_t first, auto& taken) {
            const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
            taken.assign(begin, values.end());
            values.erase(begin, values.end());
        };
        takeFrom(made_.triangles, triangles, shared.triangles);
        takeFrom(made_.vertexIndices, indices, shared.vertexIndices);
        takeFrom(made_.hasAlpha, triangles, shared.hasAlpha);
        return shared;
    }

    static glm::dvec3 centerOf(const Mesh& mesh)
    {
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const std::uint32_t index : mesh.indices) {
            low = glm::min(low, mesh.positions[index]);
            high = glm::max(high, mesh.positions[index]);
        }
        return 0.5 * low + 0.5 * high;
    }

    glm::uvec3 addVertices(const Mesh& mesh, const std::array<std::uint32_t, 3>& corners, const glm::dvec3& faceNormal)
    {
        glm::uvec3 vertices;
        for (int v = 0; v < 3; ++v) {
            const std::uint32_t corner = corners[static_cast<std::size_t>(v)];
            std::uint32_t& vertex = vertexOf_[corner];
            if (vertex == kNotYet) {
                Vertex made = makeVertex(mesh, corner);
                if (!mesh.normals.empty()) {
                    const glm::dvec3 normal = worldFromNormal_ * mesh.normals[corner];
                    const double length = glm::length(normal);
                    if (!std::isfinite(length) || !(length > 0.0)) {
                        made.normal = glm::normalize(faceNormal);
                        vertices[v] = addVertex(made);  // of this triangle alone
                        ++badNormals_;
                        continue;
                    }
                    made.normal = normal / length;
                }
                vertex = slots_.empty() ? addVertex(made) : findOrAddVertex(made);
            }
            vertices[v] = vertex;
        }
        return vertices;
    }

    // Without its normal.
    Vertex makeVertex(const Mesh& mesh, std::uint32_t index) const
    {
        Vertex vertex;
        if (mapped_) {
            vertex.uv =
                glm::vec4(mesh.uv0.empty() ? glm::vec2(0.0F) : mesh.uv0[index], mesh.uv1.empty() ? glm::vec2(0.0F) : mesh.uv1[index]);
        }
        if (!mesh.tangents.empty()) {
            const glm::dvec3 tangent = worldFromMesh_ * glm::dvec3(mesh.tangents[index]);
            const double length = glm::length(tangent);
            const bool usable = std::isfinite(length) && length > 0.0;
            vertex.tangent = usable ? glm::vec4(tangent / length, mesh.tangents[index].w) : glm::vec4(0.0F);
            // cross(normal, tangent) changes its sign when the instance mirrors.
            vertex.tangent.w *= glm::determinant(worldFromMesh_) < 0.0 ? -1.0F : 1.0F;
        }
        if (!mesh.colors.empty()) {
            vertex.color = glm::clamp(mesh.colors[index], 0.0F, 1.0F);
        }
        return vertex;
    }

    static Words wordsOf(const glm::vec3& normal, const glm::vec4& uv, const glm::vec4& tangent, const glm::vec4& color)
    {
        Words words{};
        std::memcpy(words.data(), &normal, sizeof normal);
        std::memcpy(words.data() + 3, &uv, sizeof uv);
        std::memcpy(words.data() + 7, &tangent, sizeof tangent);
        std::memcpy(words.data() + 11, &color, sizeof color);
        return words;
    }

    Words wordsOfVertex(std::uint32_t vertex) const
    {
        const auto valueOr = [vertex](const std::vector<glm::vec4>& values, float fallback) {
            return values.empty() ? glm::vec4(fallback) : values[vertex];
        };
        return wordsOf(made_.vertexNormals[vertex], valueOr(made_.vertexUvs, 0.0F), valueOr(made_.vertexTangents, 0.0F),
                       valueOr(made_.vertexColors, 1.0F));
    }

    std::uint32_t findOrAddVertex(const Vertex& vertex)
    {
        const Words words = wordsOf(vertex.normal, vertex.uv, vertex.tangent, vertex.color);
        std::size_t slot = hashWords(words) & (slots_.size() - 1);
        while (slots_[slot] != kNotYet && wordsOfVertex(slots_[slot]) != words) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        if (slots_[slot] == kNotYet) {
            slots_[slot] = addVertex(vertex);
        }
        return slots_[slot];
    }

    std::uint32_t addVertex(const Vertex& vertex)
    {
        made_.vertexNormals.push_back(vertex.normal);
        if (mapped_) {
            made_.vertexUvs.push_back(vertex.uv);
        }
        if (tangents_) {
            made_.vertexTangents.push_back(vertex.tangent);
        }
        if (colored_) {
            made_.vertexColors.push_back(vertex.color);
        }
        return static_cast<std::uint32_t>(made_.vertexNormals.size() - 1);
    }

    const Scene& scene_;
    AlphaClassifier alpha_{scene_};
    bool smooth_ = false, mapped_ = false, tangents_ = false, colored_ = false;  // what some mesh has, and some material needs
    Primitives made_;
    glm::dmat3 worldFromMesh_{1.0}, worldFromNormal_{1.0};
    std::vector<std::uint32_t> vertexOf_;  // by vertex of the mesh
    std::vector<std::uint32_t> slots_;     // of the hash table, by a vertex's hash; empty for a mesh with indices
    std::size_t flatTriangles_ = 0, badNormals_ = 0;
};

bool areIdentical(const glm::dmat4& a, const glm::dmat4& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;  // 0 and -0 place vertices differently
}

bool movesOf(const MeshInstance& instance) { return instance.motion != nullptr; }

bool areIdentical(const MeshInstance& a, const MeshInstance& b)
{
    return areIdentical(a.worldFromMesh, b.worldFromMesh) && movesOf(a) == movesOf(b) && (!movesOf(a) || *a.motion == *b.motion);
}

bool areIdentical(const Sphere& a, const Sphere& b)
{
    return std::memcmp(&a.center, &b.center, sizeof a.center) == 0 && a.radius == b.radius && a.material == b.material;
}

// Whether the materials may differ in colours alone, and in other numbers that shapes do not depend on.
bool areSameSurface(const Material& a, const Material& b)
{
    const auto shapeOf = [](const Material& m) {
        const bool isOpaque = m.alphaMode == AlphaMode::Opaque;
        return std::tuple(m.alphaMode, isOpaque ? 1.0F : m.alpha, isOpaque ? 0.0F : m.alphaCutoff, passesStraight(m), m.doubleSided,
                          m.thick, isTextured(m), m.textures[kSlotEmissive].has_value(), m.emission != glm::vec3(0.0F), m.isCatcher,
                          m.transmission > 0.0F, m.diffuseTransmission > 0.0F);
    };
    return shapeOf(a) == shapeOf(b) && a.textures[kSlotBaseColor] == b.textures[kSlotBaseColor];
}

}  // namespace

Same compareSurfaces(const Scene& before, const Primitives& primitives, const Scene& scene)
{
    const auto spheres = [](const Sphere& a, const Sphere& b) { return areIdentical(a, b); };
    const auto instances = [](const MeshInstance& a, const MeshInstance& b) { return a.mesh == b.mesh; };
    if (!before.meshes.isSameAs(scene.meshes) || before.origin != scene.origin || before.showsBackFaces != scene.showsBackFaces ||
        !std::ranges::equal(before.materials, scene.materials, areSameSurface) || before.pointRadius != scene.pointRadius ||
        before.lineRadius != scene.lineRadius || before.lonePointRadius != scene.lonePointRadius ||
        !std::ranges::equal(before.spheres, scene.spheres, spheres) || !std::ranges::equal(before.instances, scene.instances, instances)) {
        return Same::Nothing;
    }
    std::vector<bool> isShared(scene.meshes.size(), false);
    for (const SharedMesh& mesh : primitives.sharedMeshes) {
        isShared[mesh.mesh] = true;
    }
    if (!std::ranges::equal(before.instances, scene.instances, {}, movesOf, movesOf)) {
        return Same::Nothing;  // other meshes are shared
    }
    Same same = Same::Everything;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (!areIdentical(before.instances[i], scene.instances[i])) {
            same = same != Same::Nothing && isShared[scene.instances[i].mesh] ? Same::AllButPlacements : Same::Nothing;
        }
    }
    return same;
}

void placeSharedMeshes(const Scene& scene, Primitives& primitives)
{
    for (Placement& placement : primitives.placements) {
        const glm::dmat4& worldFromMesh = scene.instances[placement.instance].worldFromMesh;
        placement.linear = glm::dmat3(worldFromMesh);
        placement.translation =
            placement.linear * primitives.sharedMeshes[placement.sharedMesh].center + (glm::dvec3(worldFromMesh[3]) - scene.origin);
        const std::shared_ptr<const Motion>& motion = scene.instances[placement.instance].motion;
        placement.motion =
            motion ? std::optional(PlacedMotion{relativeTo(scene.origin, *motion), primitives.sharedMeshes[placement.sharedMesh].center})
                   : std::nullopt;
    }
}

std::uint32_t Primitives::findInstance(std::uint32_t triangle) const
{
    const auto after = std::upper_bound(firstTriangles.begin(), firstTriangles.end(), triangle);
    return static_cast<std::uint32_t>(after - firstTriangles.begin() - 1);
}

std::uint64_t Primitives::computeTriangleCount() const
{
    std::uint64_t count = triangles.size();
    for (const Placement& placement : placements) {
        count += sharedMeshes[placement.sharedMesh].triangles.size();
    }
    return count;
}

Primitives makePrimitives(const Scene& scene, std::uint64_t maxFlatTriangles)
{
    Primitives primitives = PrimitiveMaker(scene).make(maxFlatTriangles);
    liftLights(scene, primitives);
    auto id = static_cast<std::uint32_t>(primitives.count());
    for (SharedMesh& mesh : primitives.sharedMeshes) {
        mesh.firstId = id;
        id += static_cast<std::uint32_t>(mesh.triangles.size());
    }
    return primitives;
}

}  // namespace glim
