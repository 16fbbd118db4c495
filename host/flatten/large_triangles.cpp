#include "host/flatten/large_triangles.hpp"

#include "host/scene/choose_origin.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glim {
namespace {

constexpr double kMaxToPrimitive = 0x1p12, kMaxToDistance = 0x1p7;

// Cameras and lights are compared with this many triangles, the largest ones.
constexpr std::size_t kMaxCompared = 64;

// This many triangles of a mesh stand for the sizes of all.
constexpr std::size_t kMaxSampled = 64;

struct Extent {
    double size;
    std::size_t triangle;
};

double largestOf(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

double sizeOf(const Triangle& triangle)
{
    const auto& [a, b, c] = triangle.vertices;
    return largestOf(glm::dvec3(glm::max(a, glm::max(b, c))) - glm::dvec3(glm::min(a, glm::min(b, c))));
}

// The largest factor by which the placement may lengthen an extent.
double scaleOf(const Placement& placement)
{
    const glm::dmat3& m = placement.linear;
    return largestOf(glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]));
}

// A lower bound of the distance: the larger of those to the triangle's plane and to its box.
double distanceTo(const Triangle& triangle, const glm::dvec3& point)
{
    const glm::dvec3 a(triangle.vertices[0]), b(triangle.vertices[1]), c(triangle.vertices[2]);
    const glm::dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const double toPlane = std::abs(glm::dot(glm::normalize(glm::cross(b - a, c - a)), point - a));
    return std::max(toPlane, glm::length(glm::max(glm::max(low - point, point - high), glm::dvec3(0.0))));
}

bool isCloseTo(const Triangle& triangle, const glm::dvec3& point)
{
    const double distance = distanceTo(triangle, point);
    return distance > 0.0 && sizeOf(triangle) > kMaxToDistance * distance;
}

bool isCloseToLight(const Scene& scene, const Triangle& triangle)
{
    return std::ranges::any_of(scene.lights, [&](const PunctualLight& light) {
        return light.kind != PunctualLight::Kind::Directional && isCloseTo(triangle, glm::dvec3(light.position));
    });
}

std::vector<Triangle> largestOf(const std::vector<Triangle>& triangles, std::vector<Extent> extents)
{
    const auto end = extents.begin() + static_cast<std::ptrdiff_t>(std::min(kMaxCompared, extents.size()));
    std::partial_sort(extents.begin(), end, extents.end(), [](const Extent& a, const Extent& b) { return a.size > b.size; });
    std::vector<Triangle> largest;
    std::transform(extents.begin(), end, std::back_inserter(largest), [&](const Extent& extent) { return triangles[extent.triangle]; });
    return largest;
}

}  // namespace

void findLargeTriangles(FlatScene& flat, const Primitives& primitives)
{
    std::vector<Extent> extents;
    std::vector<double> sizes;
    double largest = 0.0;
    for (std::size_t i = 0; i < primitives.triangles.size(); ++i) {
        extents.push_back({sizeOf(primitives.triangles[i]), i});
        sizes.push_back(extents.back().size);
        largest = std::max(largest, sizes.back());
    }
    std::vector<double> largestInMesh;
    for (const SharedMesh& mesh : primitives.sharedMeshes) {
        double& most = largestInMesh.emplace_back(0.0);
        for (const Triangle& triangle : mesh.triangles) {
            most = std::max(most, sizeOf(triangle));
        }
    }
    for (const Placement& placement : primitives.placements) {
        const double scale = scaleOf(placement);
        const std::vector<Triangle>& triangles = primitives.sharedMeshes[placement.sharedMesh].triangles;
        for (std::size_t i = 0; i < std::min(kMaxSampled, triangles.size()); ++i) {
            sizes.push_back(scale * sizeOf(triangles[i]));
        }
        largest = std::max(largest, scale * largestInMesh[placement.sharedMesh]);
    }
    for (std::size_t i = 0; i < primitives.spheres.size() && largest > 0.0; ++i) {
        sizes.push_back(2.0 * static_cast<double>(primitives.spheres[i].radius));
    }
    flat.largest = largestOf(primitives.triangles, std::move(extents));
    const bool isLarge = !sizes.empty() && largest > kMaxToPrimitive * fineSize(std::move(sizes));
    flat.surfaceFeatures |= isLarge ? kFeatureLargeTriangles : 0U;
}

bool areLightsClose(const FlatScene& flat, const Scene& scene)
{
    return std::ranges::any_of(flat.largest, [&](const Triangle& triangle) { return isCloseToLight(scene, triangle); });
}

FeatureMask featuresSeenBy(const FlatScene& flat, const FlatCamera& camera)
{
    std::vector<glm::dvec3> places{glm::dvec3(camera.position)};
    if (const auto moving = std::ranges::find(flat.movingCameras, camera.motion, &MovingCamera::flat); moving != flat.movingCameras.end()) {
        places.insert(places.end(), moving->positions.begin(), moving->positions.end());
    }
    const bool isClose = std::ranges::any_of(flat.largest, [&](const Triangle& triangle) {
        return std::ranges::any_of(places, [&](const glm::dvec3& place) { return isCloseTo(triangle, place); });
    });
    return flat.features | (isClose ? kFeatureLargeTriangles : 0U);
}

}  // namespace glim
