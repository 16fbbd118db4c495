#include "host/flatten/start_media.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace glim {
namespace {

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

bool overlap(const Box& a, const Box& b)
{
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

Box boxOf(const Sphere& sphere)
{
    const glm::dvec3 center(sphere.center), radius(static_cast<double>(sphere.radius));
    return {center - radius, center + radius};
}

// Positions are relative to the scene's origin, as the camera's are.
std::vector<glm::dvec3> positionsOf(const Scene& scene, const MeshInstance& instance)
{
    std::vector<glm::dvec3> positions = scene.meshes[instance.mesh].positions;
    for (glm::dvec3& p : positions) {
        p = glm::dvec3(instance.worldFromMesh * glm::dvec4(p, 1.0)) - scene.origin;
    }
    return positions;
}

// Where rays of the camera begin.
Box originsOf(const FlatCamera& camera)
{
    const vec3 extent = glm::abs(camera.lensRight) + glm::abs(camera.lensUp) +
                        (camera.kind == kOrthographic ? glm::abs(camera.right) + glm::abs(camera.up) : vec3(0.0F));
    return {glm::dvec3(camera.position - extent), glm::dvec3(camera.position + extent)};
}

// Where the ray along kOutwards crosses the skin of a solid.
struct Crossing {
    double t;
    bool enters;
};

// Of all solids of one medium.
struct Surroundings {
    double winding = 0.0;  // how many of them are around the point
    std::vector<Crossing> crossings;
};

// a, b, c: the corners seen from the point. The solid angle: Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983. Their sum
// over 4 pi is the winding number, which small holes hardly change (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation
// using Generalized Winding Numbers", 2013).
void addTriangle(Surroundings& around, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double volume = glm::dot(a, glm::cross(b, c));
    const double solidAngle = 2.0 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    around.winding += solidAngle / (4.0 * std::numbers::pi);
    const glm::dvec3 ray(kOutwards),
        weights(glm::dot(ray, glm::cross(b, c)), glm::dot(ray, glm::cross(c, a)), glm::dot(ray, glm::cross(a, b)));
    const double sum = weights.x + weights.y + weights.z;  // > 0 where the triangle is seen from behind
    const double side = sum > 0.0 ? 1.0 : -1.0;
    if (sum != 0.0 && glm::all(glm::greaterThanEqual(side * weights, glm::dvec3(0.0))) && volume / sum > 0.0) {
        around.crossings.push_back({volume / sum, sum < 0.0});
    }
}

void addSphere(Surroundings& around, const Sphere& sphere, const glm::dvec3& point)
{
    const glm::dvec3 center = glm::dvec3(sphere.center) - point;
    const double radius = static_cast<double>(sphere.radius), along = glm::dot(glm::dvec3(kOutwards), center);
    const double inside = radius * radius - glm::dot(center, center), square = along * along + inside;
    around.winding += inside > 0.0 ? 1.0 : 0.0;
    if (square >= 0.0 && along + std::sqrt(square) > 0.0) {
        if (along - std::sqrt(square) > 0.0) {
            around.crossings.push_back({along - std::sqrt(square), true});
        }
        around.crossings.push_back({along + std::sqrt(square), false});
    }
}

// Where the ray leaves the solids around the point, nearest first: those that it has not entered before.
std::vector<double> exitsOf(Surroundings around)
{
    std::ranges::sort(around.crossings, {}, &Crossing::t);
    std::vector<double> exits;
    int entered = 0;
    for (const Crossing& crossing : around.crossings) {
        if (crossing.enters || entered > 0) {
            entered += crossing.enters ? 1 : -1;
        } else {
            exits.push_back(crossing.t);
        }
    }
    const long count = std::max(0L, std::lround(around.winding));  // a crossing at an edge counts twice, or never
    exits.resize(static_cast<std::size_t>(count), std::numeric_limits<double>::infinity());
    return exits;
}

// Looks at the solids of a scene from a box of points.
class SolidFinder {
public:
    SolidFinder(const Scene& scene, const FlatScene& flat, const Box& origins)
        : scene_(scene),
          flat_(flat),
          origins_(origins),
          middle_(0.5 * (origins.low + origins.high))
    {}

    // Of the camera's rays: as in FlatCamera.
    uint find()
    {
        std::map<uint, Box> boxes;  // of all solids of a medium
        for (const MeshInstance& instance : scene_.instances) {
            for (const glm::dvec3& p : mediumOf(instance) != 0 ? positionsOf(scene_, instance) : std::vector<glm::dvec3>()) {
                boxes[mediumOf(instance)].add(p);
            }
        }
        for (const MeshInstance& instance : scene_.instances) {
            if (const uint medium = mediumOf(instance); medium != 0 && overlap(origins_, boxes[medium])) {
                addMesh(instance, around_[medium]);
            }
        }
        for (const Sphere& sphere : scene_.spheres) {
            if (const uint medium = flat_.mediumOfMaterial[sphere.material]; medium != 0) {
                addSphere(around_[medium], sphere, middle_);
                straddles_ = straddles_ || isSkinIn(sphere);
            }
        }
        return straddles_ ? kMediaVary : wordOf();
    }

private:
    uint mediumOf(const MeshInstance& instance) const { return flat_.mediumOfMaterial[scene_.meshes[instance.mesh].material]; }

    void addMesh(const MeshInstance& instance, Surroundings& around)
    {
        const Mesh& mesh = scene_.meshes[instance.mesh];
        const std::vector<glm::dvec3> positions = positionsOf(scene_, instance);
        const bool mirrors = glm::determinant(glm::dmat3(instance.worldFromMesh)) < 0.0;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const glm::dvec3 &a = positions[mesh.indices[i]], &b = positions[mesh.indices[i + (mirrors ? 2 : 1)]],
                             &c = positions[mesh.indices[i + (mirrors ? 1 : 2)]];
            addTriangle(around, a - middle_, b - middle_, c - middle_);
            straddles_ = straddles_ || overlap(origins_, Box{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
    }

    // Whether part of the sphere's surface lies among the points.
    bool isSkinIn(const Sphere& sphere) const
    {
        const glm::dvec3 center(sphere.center);
        const double nearest = glm::distance(center, glm::clamp(center, origins_.low, origins_.high));
        const double farthest = glm::length(glm::max(glm::abs(origins_.low - center), glm::abs(origins_.high - center)));
        return nearest <= static_cast<double>(sphere.radius) && farthest >= static_cast<double>(sphere.radius);
    }

    // The solid that the ray leaves first is the innermost. Where there are more than a ray remembers, the device finds and reports them.
    uint wordOf() const
    {
        std::vector<std::pair<double, uint>> inside;
        for (const auto& [medium, around] : around_) {
            for (const double exit : exitsOf(around)) {
                inside.emplace_back(exit, medium);
            }
        }
        std::ranges::sort(inside);
        if (inside.size() > kMaxNestedMedia) {
            return kMediaVary;
        }
        uint word = 0;
        for (std::size_t place = 0; place < inside.size(); ++place) {
            word |= inside[place].second << (place * kMediumBits);
        }
        return word;
    }

    const Scene& scene_;
    const FlatScene& flat_;
    const Box origins_;
    const glm::dvec3 middle_;
    std::map<uint, Surroundings> around_;  // by medium
    bool straddles_ = false;               // some points are inside of a solid, others are not
};

// Boxes of what a predicate on materials chooses.
std::vector<Box> boxesOf(const Scene& scene, const std::function<bool(std::uint32_t material)>& isChosen)
{
    std::vector<Box> boxes;
    for (const MeshInstance& instance : scene.instances) {
        if (isChosen(scene.meshes[instance.mesh].material)) {
            Box& box = boxes.emplace_back();
            for (const glm::dvec3& p : positionsOf(scene, instance)) {
                box.add(p);
            }
        }
    }
    for (const Sphere& sphere : scene.spheres) {
        if (isChosen(sphere.material)) {
            boxes.push_back(boxOf(sphere));
        }
    }
    return boxes;
}

}  // namespace

FlatCamera placeInMedia(FlatCamera camera, const Scene& scene, const FlatScene& flat)
{
    const bool tracked = (flat.features & kFeatureMedia) != 0;
    camera.media = tracked ? SolidFinder(scene, flat, originsOf(camera)).find() : 0;
    return camera;
}

bool mayLampsBeInMedia(const Scene& scene, const FlatScene& flat)
{
    if ((flat.features & kFeatureMedia) == 0) {
        return false;
    }
    const auto isLamp = [&scene](std::uint32_t material) { return scene.materials[material].emission != glm::vec3(0.0F); };
    std::vector<Box> lamps = boxesOf(scene, isLamp);
    for (const PunctualLight& light : scene.lights) {
        if (light.kind != PunctualLight::Kind::Directional) {
            lamps.push_back({glm::dvec3(light.position), glm::dvec3(light.position)});
        }
    }
    Box lit;  // around all of them: many lamps cost no more than one
    for (const Box& lamp : lamps) {
        lit.add(lamp.low);
        lit.add(lamp.high);
    }
    const std::vector<Box> solids = boxesOf(scene, [&](std::uint32_t material) { return flat.mediumOfMaterial[material] != 0; });
    return std::ranges::any_of(solids, [&lit](const Box& solid) { return overlap(solid, lit); });
}

}  // namespace glim
