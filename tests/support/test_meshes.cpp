#include "tests/support/test_meshes.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace glim {
namespace {

void subdivide(Triangles& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int levels)
{
    if (levels == 0) {
        mesh.push_back({{glm::vec3(a), glm::vec3(b), glm::vec3(c)}});
        return;
    }
    // Sums commute exactly, so both neighbours of an edge get the same middle.
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    subdivide(mesh, a, ab, ca, levels - 1);
    subdivide(mesh, b, bc, ab, levels - 1);
    subdivide(mesh, c, ca, bc, levels - 1);
    subdivide(mesh, ab, bc, ca, levels - 1);
}

glm::vec3 randomPoint(std::mt19937& random, float size)
{
    std::uniform_real_distribution<float> within(-size, size);
    const float x = within(random), y = within(random);
    return {x, y, within(random)};
}

// From -1 to 1, thinner and thinner towards both ends, down to 1e-6.
std::vector<float> ringHeights(int rings)
{
    std::vector<float> heights{-1.0F};
    for (int i = rings; i >= -rings; --i) {
        const double distance = 1.0 - std::pow(10.0, -6.0 * std::abs(i) / rings);
        heights.push_back(static_cast<float>(i > 0 ? -distance : distance));
    }
    heights.push_back(1.0F);
    return heights;
}

}  // namespace

Triangles icosphere(int subdivisions)
{
    const double g = std::numbers::phi;
    const glm::dvec3 v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    constexpr int kFaces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    Triangles mesh;
    for (const auto& face : kFaces) {
        subdivide(mesh, glm::normalize(v[face[0]]), glm::normalize(v[face[1]]), glm::normalize(v[face[2]]), subdivisions);
    }
    return mesh;
}

Triangles sliverBox(int rings)
{
    const glm::vec2 corners[5] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    const glm::vec2 apex(1.0F - 1e-6F, 0.3F);
    const std::vector<float> heights = ringHeights(rings);
    Triangles mesh;
    for (int k = 0; k < 4; ++k) {
        const glm::vec2 from = corners[k], to = corners[k + 1];
        for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
            const glm::vec3 a(from, heights[i]), b(to, heights[i]), c(to, heights[i + 1]), d(from, heights[i + 1]);
            mesh.push_back({{a, b, c}});
            mesh.push_back({{a, c, d}});
        }
        mesh.push_back({{glm::vec3(from, 1), glm::vec3(to, 1), glm::vec3(apex, 1)}});
        mesh.push_back({{glm::vec3(to, -1), glm::vec3(from, -1), glm::vec3(apex, -1)}});
    }
    return mesh;
}

Triangles terrain(int cells)
{
    const auto vertex = [cells](int i, int j) {
        const float x = 20.0F * static_cast<float>(i) / static_cast<float>(cells) - 10.0F;
        const float z = 20.0F * static_cast<float>(j) / static_cast<float>(cells) - 10.0F;
        return glm::vec3(x, std::sin(0.7F * x) * std::cos(0.9F * z) + 0.2F * std::sin(5.0F * x + 3.0F * z), z);
    };
    Triangles mesh;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            mesh.push_back({{vertex(i, j), vertex(i, j + 1), vertex(i + 1, j)}});
            mesh.push_back({{vertex(i + 1, j + 1), vertex(i + 1, j), vertex(i, j + 1)}});
        }
    }
    return mesh;
}

Triangles randomTriangles(std::size_t count, float size, std::uint32_t seed)
{
    std::mt19937 random(seed);
    Triangles mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 center = randomPoint(random, 1.0F);
        const glm::vec3 a = randomPoint(random, size), b = randomPoint(random, size), c = randomPoint(random, size);
        mesh.push_back({{center + a, center + b, center + c}});
    }
    return mesh;
}

Triangles aslantPrism(int sides, int rings)
{
    const glm::dmat3 turned(glm::normalize(glm::dvec3(1, -1, 0)), glm::normalize(glm::dvec3(1, 1, -2)),
                            glm::normalize(glm::dvec3(1, 1, 1)));
    const auto vertex = [&](int side, int ring, double end) {
        const double angle = 2.0 * std::numbers::pi * (side % sides) / sides, radius = static_cast<double>(ring) / rings;
        return glm::vec3(turned * glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), end));
    };
    Triangles mesh;
    const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
        mesh.push_back({{a, b, c}});
        mesh.push_back({{a, c, d}});
    };
    for (int i = 0; i < sides; ++i) {
        quad(vertex(i, rings, -2.0), vertex(i + 1, rings, -2.0), vertex(i + 1, rings, 2.0), vertex(i, rings, 2.0));
        for (const double end : {-2.0, 2.0}) {
            const int first = end > 0.0 ? i : i + 1, second = end > 0.0 ? i + 1 : i;  // fronts outwards
            mesh.push_back({{vertex(0, 0, end), vertex(first, 1, end), vertex(second, 1, end)}});
            for (int ring = 1; ring < rings; ++ring) {
                quad(vertex(first, ring, end), vertex(first, ring + 1, end), vertex(second, ring + 1, end), vertex(second, ring, end));
            }
        }
    }
    return mesh;
}

Triangles strips(std::size_t count, std::uint32_t seed)
{
    std::mt19937 random(seed);
    Triangles mesh = randomTriangles(40 * count, 0.1F, seed + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 from = glm::vec3(-0.7F) + randomPoint(random, 0.3F), to = glm::vec3(0.7F) + randomPoint(random, 0.3F);
        const glm::vec3 across = 0.2F * glm::normalize(randomPoint(random, 1.0F));
        mesh.push_back({{from, to, to + across}});
        mesh.push_back({{from, to + across, from + across}});
    }
    return mesh;
}

std::vector<Sphere> randomSpheres(std::size_t count, float largestRadius, std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> radius(0.05F * largestRadius, largestRadius);
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 center = randomPoint(random, 1.0F);
        spheres.push_back({"", center, radius(random), 0});
    }
    return spheres;
}

Triangles coincidentTriangles(std::size_t count)
{
    return Triangles(count, Triangle{{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)}});
}

Triangles growingLine(std::size_t count, float first, double ratio)
{
    Triangles mesh;
    double start = 0.0, length = static_cast<double>(first);
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<float>(start), y = static_cast<float>(length);
        start += length;
        const auto end = static_cast<float>(start);
        mesh.push_back({{glm::vec3(x, 0, -y), glm::vec3(end, 0.3F * y, -y), glm::vec3(x, 0.1F * y, y)}});
        length *= ratio;
    }
    return mesh;
}

Triangles placed(Triangles mesh, float scale, float shift)
{
    for (Triangle& triangle : mesh) {
        for (glm::vec3& vertex : triangle.vertices) {
            vertex = (vertex + shift) * scale;
        }
    }
    return mesh;
}

Primitives makeTestPrimitives(const Triangles& triangles, const std::vector<Sphere>& spheres)
{
    Primitives primitives;
    primitives.triangles = triangles;
    std::vector<PlacedSphere> placed;
    for (const Sphere& sphere : spheres) {
        placed.push_back({sphere.center, sphere.radius, sphere.material});
    }
    primitives.spheres = PlacedSpheres(std::move(placed));
    primitives.firstTriangles = {0, static_cast<std::uint32_t>(triangles.size())};
    return primitives;
}

void addMesh(Scene& scene, const Triangles& triangles, std::uint32_t material, const std::vector<glm::vec3>& normals)
{
    Mesh mesh;
    mesh.material = material;
    for (const glm::vec3& vertex : listVertices(triangles)) {
        mesh.positions.emplace_back(vertex);
    }
    mesh.normals.assign(normals.begin(), normals.end());
    mesh.indices.resize(mesh.positions.size());
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
    scene.instances.push_back({"", static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.change().push_back(std::move(mesh));
}

void addInstance(Scene& scene, std::uint32_t mesh, const glm::dvec3& at, double angle, const glm::dvec3& scale)
{
    const glm::dmat4 turned = glm::rotate(glm::translate(glm::dmat4(1.0), at), angle, glm::normalize(glm::dvec3(0.3, 1.0, 0.2)));
    scene.instances.push_back({"", mesh, glm::scale(turned, scale)});
}

std::vector<glm::vec3> listVertices(const Triangles& triangles)
{
    std::vector<glm::vec3> vertices;
    for (const Triangle& triangle : triangles) {
        vertices.insert(vertices.end(), std::begin(triangle.vertices), std::end(triangle.vertices));
    }
    return vertices;
}

Scene makeTestScene(const Triangles& triangles, const std::vector<Sphere>& spheres)
{
    Scene scene;
    scene.materials.emplace_back().doubleSided = true;
    scene.spheres = spheres;
    if (!triangles.empty()) {
        addMesh(scene, triangles);
    }
    return scene;
}

}  // namespace glim
