#include "host/flatten/lift_lamps.hpp"

#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace glim {
namespace {

constexpr std::size_t kMostComparisons = 100'000'000;
constexpr float kCoplanar = 0x1p-22F;  // of the coordinates: two roundings
constexpr float kLift = 0x1p-18F;      // of the coordinates: what a hit at a grazing angle of .1 is off by

struct Box {
    glm::vec3 low, high;
};

Box boxOf(const Triangle& triangle)
{
    const auto& [a, b, c] = triangle.vertices;
    return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

float sizeOf(const Box& box)
{
    const glm::vec3 size = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::max({size.x, size.y, size.z});
}

bool overlap(const Box& a, const Box& b, float slack)
{
    return glm::all(glm::lessThanEqual(a.low, b.high + slack)) && glm::all(glm::lessThanEqual(b.low, a.high + slack));
}

// Whether the triangles touch more than at an edge: some direction in the plane, across an edge of either, would tell them apart.
bool overlapInPlane(const Triangle& a, const Triangle& b, const glm::dvec3& normal, double slack)
{
    for (const Triangle* of : {&a, &b}) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 from(of->vertices[i]);
            const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(of->vertices[(i + 1) % 3]) - from));
            const auto rangeOf = [&](const Triangle& triangle) {
                std::array<double, 3> at{};
                for (std::size_t v = 0; v < 3; ++v) {
                    at[v] = glm::dot(across, glm::dvec3(triangle.vertices[v]) - from);
                }
                return std::pair(*std::ranges::min_element(at), *std::ranges::max_element(at));
            };
            const auto [aLow, aHigh] = rangeOf(a);
            const auto [bLow, bHigh] = rangeOf(b);
            if (std::min(aHigh, bHigh) - std::max(aLow, bLow) <= slack) {
                return false;
            }
        }
    }
    return true;
}

// How far the lamp must move, or 0.
float liftOf(const Triangle& lamp, const Triangle& other)
{
    const Box box = boxOf(lamp), otherBox = boxOf(other);
    const float size = std::max(sizeOf(box), sizeOf(otherBox));
    if (!overlap(box, otherBox, kCoplanar * size)) {
        return 0.0F;
    }
    const double slack = static_cast<double>(kCoplanar * size);
    const glm::dvec3 normal = glm::normalize(faceNormal(lamp)), at(lamp.vertices[0]);
    const bool coplanar =
        std::ranges::all_of(other.vertices, [&](const glm::vec3& v) { return std::abs(glm::dot(normal, glm::dvec3(v) - at)) <= slack; });
    return coplanar && overlapInPlane(lamp, other, normal, 4.0 * slack) ? kLift * size : 0.0F;
}

}  // namespace

void liftLamps(const Scene& scene, Primitives& primitives)
{
    std::vector<bool> emits;  // by triangle
    std::vector<std::uint32_t> lamps;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Material& material = scene.materials[scene.meshes[scene.instances[i].mesh].material];
        const bool lamp = material.emission != glm::vec3(0.0F) && !material.doubleSided && !material.emissiveTexture;
        emits.resize(primitives.firstTriangles[i + 1], lamp);
    }
    for (std::uint32_t i = 0; i < emits.size(); ++i) {
        if (emits[i]) {
            lamps.push_back(i);
        }
    }
    if (lamps.empty() || emits.size() > kMostComparisons / lamps.size()) {
        return;
    }
    std::size_t moved = 0;
    for (const std::uint32_t lamp : lamps) {
        float lift = 0.0F;
        for (std::size_t other = 0; other < emits.size(); ++other) {
            lift = std::max(lift, emits[other] ? 0.0F : liftOf(primitives.triangles[lamp], primitives.triangles[other]));
        }
        if (lift > 0.0F) {
            ++moved;
            const glm::vec3 by(static_cast<double>(lift) * glm::normalize(faceNormal(primitives.triangles[lamp])));
            for (glm::vec3& vertex : primitives.triangles[lamp].vertices) {
                vertex += by;
            }
        }
    }
    if (moved > 0) {
        primitives.warnings.push_back(counted(moved, "emitting triangle") +
                                      " in the plane of another surface: moved by some millionths of their place to their front");
    }
}

}  // namespace glim
