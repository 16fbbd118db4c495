#include "host/scene/make_floor.hpp"

#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glim {
namespace {

// In units of the longest side of what stands on the floor. The bend begins behind what a camera that frames the scene sees of its subject,
// and the wall ends above that.
constexpr double kHalfSide = 10.0, kBendBegin = 1.5, kBendRadius = 1.0, kWallHeight = 8.0;
constexpr int kBendSides = 32;
constexpr std::uint32_t kDiscSides = 128;

// A point of the floor's cross-section: how far behind the middle and how high it is, and the way its front faces.
struct ProfilePoint {
    glm::dvec2 place, normal;
};

std::vector<ProfilePoint> makeProfile()
{
    std::vector<ProfilePoint> profile{{{-kHalfSide, 0.0}, {0.0, 1.0}}};
    const glm::dvec2 center(kBendBegin, kBendRadius);
    for (int i = 0; i <= kBendSides; ++i) {
        const double angle = 0.5 * std::numbers::pi * i / kBendSides;
        const glm::dvec2 outwards(std::sin(angle), -std::cos(angle));
        profile.push_back({center + kBendRadius * outwards, -outwards});
    }
    profile.push_back({{kBendBegin + kBendRadius, kWallHeight}, {-1.0, 0.0}});
    return profile;
}

// `behind`: a unit vector along the floor.
Mesh makeBackdrop(const glm::dvec3& middle, const glm::dvec3& behind, double unit)
{
    const glm::dvec3 up(0.0, 1.0, 0.0), right = glm::cross(behind, up);
    Mesh mesh;
    for (const ProfilePoint& point : makeProfile()) {
        for (const double side : {-kHalfSide, kHalfSide}) {
            mesh.positions.push_back(middle + unit * (point.place.x * behind + point.place.y * up + side * right));
            mesh.normals.push_back(point.normal.x * behind + point.normal.y * up);
        }
    }
    for (std::uint32_t i = 0; i + 3 < mesh.positions.size(); i += 2) {
        mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});
    }
    return mesh;
}

// Round, so that its horizon is level whichever way the camera looks.
Mesh makeDisc(const glm::dvec3& middle, double unit)
{
    Mesh mesh;
    mesh.positions.push_back(middle);
    for (std::uint32_t i = 0; i < kDiscSides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kDiscSides;
        mesh.positions.push_back(middle + unit * kHalfSide * glm::dvec3(std::sin(angle), 0.0, std::cos(angle)));
        mesh.indices.insert(mesh.indices.end(), {0, 1 + i, 1 + (i + 1) % kDiscSides});
    }
    return mesh;
}

Material makeFloorMaterial(const SceneFloor& floor)
{
    Material material = makeLambert(floor.color);
    material.name = kFloorName;
    if (floor.roughness) {
        material.specular = 1.0F;
        material.roughness = *floor.roughness;
    }
    return material;
}

}  // namespace

Scene makeFloor(const SceneFloor& floor, const Scene& scene)
{
    Scene everything = scene;
    everything.addedInstances = everything.addedSpheres = 0;
    const WorldBox box = computeWorldBox(everything);
    const glm::dvec3 low = scene.origin + glm::dvec3(box.low), high = scene.origin + glm::dvec3(box.high), extent = high - low;
    const glm::dvec3 middle(0.5 * (low.x + high.x), floor.height.value_or(low.y), 0.5 * (low.z + high.z));
    const double unit = std::max({extent.x, extent.y, extent.z}), azimuth = glm::radians(floor.backdrop.value_or(0.0));
    Mesh mesh = floor.backdrop ? makeBackdrop(middle, {std::sin(azimuth), 0.0, -std::cos(azimuth)}, unit) : makeDisc(middle, unit);
    mesh.name = kFloorName;
    Scene made;
    made.meshes = std::vector<Mesh>{std::move(mesh)};
    made.meshNames = made.nodeNames = {kFloorName};
    made.instances = {{.name = kFloorName, .node = 0}};
    made.materials = {makeFloorMaterial(floor)};
    return made;
}

}  // namespace glim
