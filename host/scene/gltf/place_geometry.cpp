#include "host/scene/gltf/place_geometry.hpp"

#include "host/scene/gltf/read_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace glim {
namespace {

// Columns of a uniform scale agree in length and are orthogonal up to this share: matrices are often printed floats.
constexpr double kUniformScale = 1e-5;

// The origin is the box's centre rounded to 2^-8 of the extent, so that subtracting it is exact even where the centre
// itself needs all 53 bits.
constexpr int kOriginBits = 8;

struct Instance {
    const MeshPart* part;
    std::size_t node;
    glm::dmat3 linear;
    glm::dvec3 translation;
};

struct WorldSphere {
    Sphere sphere;  // all but the centre
    glm::dvec3 center;
    std::size_t node;
};

struct Box {
    glm::dvec3 min{std::numeric_limits<double>::infinity()};
    glm::dvec3 max{-std::numeric_limits<double>::infinity()};

    void extend(const glm::dvec3& point)
    {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
};

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void checkPoint(const GltfFile& file, std::size_t node, const glm::dvec3& point, bool fits)
{
    if (!fits) {
        refuse(file, nodeLabel(file, node) + " places a point at " + toText(point.x) + " " + toText(point.y) + " " +
                         toText(point.z) + "; expected coordinates that fit a float");
    }
}

// The one place where positions become float32.
glm::vec3 toFloat(const GltfFile& file, std::size_t node, const glm::dvec3& point)
{
    const glm::vec3 rounded(point);
    checkPoint(file, node, point, isFinite(rounded));
    return rounded;
}

glm::dvec3 computeOrigin(const Box& box)
{
    const glm::dvec3 center = 0.5 * box.min + 0.5 * box.max;
    const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
    if (!std::isfinite(extent) || extent == 0.0) {
        return center;
    }
    const double grid = std::ldexp(1.0, std::ilogb(extent) - kOriginBits);
    return glm::dvec3(std::round(center.x / grid), std::round(center.y / grid), std::round(center.z / grid)) * grid +
           0.0;  // no negative zero
}

WorldSphere readSphere(const GltfFile& file, const PlacedNode& node, std::uint32_t defaultMaterial)
{
    const tinygltf::Value& source = file.model.nodes[node.index].extras.Get("sphere");
    const glm::dmat3 linear = readLinear(file, node);
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    const glm::dmat3 gram = glm::transpose(linear) * linear;
    for (int c = 0; c < 9; ++c) {
        const double expected = c / 3 == c % 3 ? scale * scale : 0.0;
        if (!(std::abs(gram[c / 3][c % 3] - expected) <= kUniformScale * scale * scale)) {
            refuse(file, nodeLabel(file, node.index) + " scales its sphere by " + toText(glm::length(linear[0])) +
                             " " + toText(glm::length(linear[1])) + " " + toText(glm::length(linear[2])) +
                             " or shears it; expected a uniform scale");
        }
    }
    WorldSphere world;
    world.node = node.index;
    world.center = glm::dvec3(node.worldFromNode[3]);
    world.sphere.name = file.model.nodes[node.index].name;
    world.sphere.radius = static_cast<float>(scale * source.Get("radius").GetNumberAsDouble());
    world.sphere.material = source.Has("material") ? static_cast<std::uint32_t>(source.Get("material").GetNumberAsInt())
                                                   : defaultMaterial;
    if (!std::isfinite(world.sphere.radius)) {
        refuse(file, nodeLabel(file, node.index) + " has a sphere of infinite radius; expected one that fits a float");
    }
    return world;
}

class GeometryPlacer {
public:
    GeometryPlacer(const GltfFile& file, Scene& scene)
        : m_file(file), m_scene(scene), m_defaultMaterial(static_cast<std::uint32_t>(scene.materials.size() - 1))
    {
    }

    void collect(const PlacedNode& node);
    void emit();
    void finish();

private:
    Box computeBox() const;
    void emitInstance(const Instance& instance);
    void emitTriangle(const Instance& instance, const glm::vec3 (&vertices)[3], const std::uint32_t (&corners)[3],
                      const glm::dmat3& worldFromNormal);
    std::uint32_t materialOf(const MeshPart& part) const
    {
        return part.material < 0 ? m_defaultMaterial : static_cast<std::uint32_t>(part.material);
    }

    const GltfFile& m_file;
    Scene& m_scene;
    std::uint32_t m_defaultMaterial;
    std::map<int, std::vector<MeshPart>> m_meshes;
    std::vector<Instance> m_instances;
    std::vector<WorldSphere> m_spheres;
    bool m_smooth = false;
    std::size_t m_flatTriangles = 0, m_emptySpheres = 0, m_badNormals = 0;
};

void GeometryPlacer::collect(const PlacedNode& node)
{
    const tinygltf::Node& source = m_file.model.nodes[node.index];
    if (source.mesh >= 0) {
        if (m_meshes.count(source.mesh) == 0) {
            m_meshes[source.mesh] = readMesh(m_file, static_cast<std::size_t>(source.mesh), m_scene.notices);
        }
        const glm::dmat3 linear = readLinear(m_file, node);
        for (const MeshPart& part : m_meshes[source.mesh]) {
            m_instances.push_back({&part, node.index, linear, glm::dvec3(node.worldFromNode[3])});
            m_smooth = m_smooth || !part.normals.empty();
        }
    }
    if (source.extras.IsObject() && source.extras.Has("sphere")) {
        WorldSphere sphere = readSphere(m_file, node, m_defaultMaterial);
        if (sphere.sphere.radius > 0.0F) {
            m_spheres.push_back(std::move(sphere));
        } else {
            ++m_emptySpheres;
        }
    }
}

Box GeometryPlacer::computeBox() const
{
    Box box;
    for (const Instance& instance : m_instances) {
        for (const std::uint32_t corner : instance.part->corners) {
            const glm::dvec3 world = instance.linear * instance.part->positions[corner] + instance.translation;
            checkPoint(m_file, instance.node, world, isFinite(world));
            box.extend(world);
        }
    }
    for (const WorldSphere& sphere : m_spheres) {
        checkPoint(m_file, sphere.node, sphere.center, isFinite(sphere.center));
        box.extend(sphere.center - static_cast<double>(sphere.sphere.radius));
        box.extend(sphere.center + static_cast<double>(sphere.sphere.radius));
    }
    return box;
}

void GeometryPlacer::emit()
{
    std::size_t triangleCount = 0;
    for (const Instance& instance : m_instances) {
        triangleCount += instance.part->corners.size() / 3;
    }
    if (triangleCount > std::numeric_limits<std::uint32_t>::max()) {
        refuse(m_file, "the scene has " + std::to_string(triangleCount) + " triangles; expected at most 4294967295");
    }
    m_scene.origin = triangleCount + m_spheres.size() == 0 ? glm::dvec3(0.0) : computeOrigin(computeBox());
    m_scene.triangles.reserve(triangleCount);
    m_scene.normals.reserve(m_smooth ? triangleCount : 0);
    for (const Instance& instance : m_instances) {
        emitInstance(instance);
    }
    for (WorldSphere& sphere : m_spheres) {
        sphere.sphere.center = toFloat(m_file, sphere.node, sphere.center - m_scene.origin);
        m_scene.spheres.push_back(sphere.sphere);
    }
}

// Inverse transpose up to a positive factor: the cofactors, with the determinant's sign.
glm::dmat3 computeWorldFromNormal(const glm::dmat3& linear)
{
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

void GeometryPlacer::emitInstance(const Instance& instance)
{
    const MeshPart& part = *instance.part;
    Primitive primitive;
    primitive.name = m_file.model.nodes[instance.node].name.empty() ? part.name
                                                                    : m_file.model.nodes[instance.node].name;
    primitive.firstTriangle = static_cast<std::uint32_t>(m_scene.triangles.size());
    primitive.material = materialOf(part);
    primitive.smooth = !part.normals.empty();

    // Moved close to zero first, so that far from the world's origin nothing is rounded away.
    const glm::dvec3 translation = instance.translation - m_scene.origin;
    const glm::dmat3 worldFromNormal = computeWorldFromNormal(instance.linear);
    const std::size_t second = glm::determinant(instance.linear) < 0.0 ? 2 : 1;  // a mirrored front stays in front
    for (std::size_t i = 0; i < part.corners.size(); i += 3) {
        const std::uint32_t corners[3] = {part.corners[i], part.corners[i + second], part.corners[i + 3 - second]};
        glm::vec3 vertices[3];
        for (int v = 0; v < 3; ++v) {
            const glm::dvec3 position = instance.linear * part.positions[corners[v]] + translation;
            vertices[v] = toFloat(m_file, instance.node, position);
        }
        emitTriangle(instance, vertices, corners, worldFromNormal);
    }
    primitive.triangleCount = static_cast<std::uint32_t>(m_scene.triangles.size()) - primitive.firstTriangle;
    if (primitive.triangleCount > 0) {
        m_scene.primitives.push_back(std::move(primitive));
    }
}

void GeometryPlacer::emitTriangle(const Instance& instance, const glm::vec3 (&vertices)[3],
                                  const std::uint32_t (&corners)[3], const glm::dmat3& worldFromNormal)
{
    const glm::dvec3 origin(vertices[0]);
    const glm::dvec3 faceNormal = glm::cross(glm::dvec3(vertices[1]) - origin, glm::dvec3(vertices[2]) - origin);
    if (faceNormal == glm::dvec3(0.0)) {
        ++m_flatTriangles;
        return;
    }
    m_scene.triangles.push_back({{vertices[0], vertices[1], vertices[2]}});
    if (!m_smooth) {
        return;
    }
    const glm::vec3 face(glm::normalize(faceNormal));
    TriangleNormals normals{{face, face, face}};
    for (int v = 0; v < 3 && !instance.part->normals.empty(); ++v) {
        const glm::dvec3 normal = worldFromNormal * instance.part->normals[corners[v]];
        const double length = glm::length(normal);
        if (std::isfinite(length) && length > 0.0) {
            normals.normals[v] = glm::vec3(normal / length);
        } else {
            ++m_badNormals;
        }
    }
    m_scene.normals.push_back(normals);
}

void GeometryPlacer::finish()
{
    if (m_flatTriangles > 0) {
        m_scene.notices.push_back("left out " + std::to_string(m_flatTriangles) + " triangles of zero area");
    }
    if (m_emptySpheres > 0) {
        m_scene.notices.push_back("left out " + std::to_string(m_emptySpheres) + " spheres of zero radius");
    }
    if (m_badNormals > 0) {
        m_scene.notices.push_back("used the face normal in place of " + std::to_string(m_badNormals) +
                                  " normals that are zero or not finite");
    }
    if (m_scene.triangles.empty() && m_scene.spheres.empty()) {
        refuse(m_file, "the scene has no triangle and no sphere to draw (" + std::to_string(m_flatTriangles) +
                           " of zero area, " + std::to_string(m_emptySpheres) +
                           " of zero radius); expected at least one");
    }
}

}  // namespace

void placeGeometry(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene)
{
    GeometryPlacer placer(file, scene);
    for (const PlacedNode& node : nodes) {
        placer.collect(node);
    }
    placer.emit();
    placer.finish();
}

}  // namespace glim
