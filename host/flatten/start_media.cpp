#include "host/flatten/start_media.hpp"

#include "host/flatten/bounds.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <ranges>
#include <utility>
#include <vector>

namespace glim {
namespace {

// A primitive that rays can meet: a sphere, or a triangle whose front is counter-clockwise.
struct Surface {
    std::uint32_t material;
    bool isSphere;
    glm::dvec3 corners[3];  // of a sphere: the centre, the radius three times, nothing

    Bounds bounds() const
    {
        Bounds bounds;
        if (isSphere) {
            bounds = {corners[0] - corners[1], corners[0] + corners[1]};
        } else {
            for (const glm::dvec3& corner : corners) {
                bounds.add(corner);
            }
        }
        return bounds;
    }
};

Surface makeSurface(const uvec4* ref)
{
    const auto vectorOf = [](const uvec4& texel) { return glm::dvec3(std::bit_cast<glm::vec3>(uvec3(texel))); };
    Surface surface{ref[1].w & kMaterialMask, (ref[1].w & kSphereBit) != 0, {}};
    for (int i = 0; i < 3; ++i) {
        surface.corners[i] = vectorOf(ref[i]);
    }
    surface.corners[1] = surface.isSphere ? glm::dvec3(surface.corners[1].x) : surface.corners[1];
    return surface;
}

Surface placed(Surface surface, const InstanceData& by)
{
    const glm::dmat3 linear(by.column0, by.column1, by.column2);
    for (glm::dvec3& corner : surface.corners) {
        corner = linear * corner + glm::dvec3(by.translation);
    }
    if (by.mirrors != 0) {
        std::swap(surface.corners[1], surface.corners[2]);
    }
    return surface;
}

// Visits each primitive of each instance but lines once, with the float32 coordinates that the device has. Triangles share their rounded
// vertices, so a closed surface stays closed.
template <class Visit>
void forEachSurface(const FlatScene& flat, const Visit& visit)
{
    const auto idOf = [&flat](std::uint32_t ref) { return flat.primitiveRefs[std::size_t{ref} * kPrimitiveRefTexels].w; };
    const auto visitRefs = [&](std::uint32_t begin, std::uint32_t end, const auto& place) {
        const auto refs = std::views::iota(begin, end);
        if (refs.empty()) {
            return;
        }
        const auto [first, last] = std::ranges::minmax(refs | std::views::transform(idOf));
        std::vector<bool> seen(last - first + 1);
        for (const std::uint32_t ref : refs) {
            const std::uint32_t bits = flat.primitiveRefs[std::size_t{ref} * kPrimitiveRefTexels + 1].w;
            const bool isLine = (bits & kSphereBit) != 0 && (bits & kSliverBit) != 0;
            if (!isLine && !seen[idOf(ref) - first]) {
                seen[idOf(ref) - first] = true;
                visit(place(makeSurface(&flat.primitiveRefs[std::size_t{ref} * kPrimitiveRefTexels])));
            }
        }
    };
    std::vector<InstanceData> instances;
    for (auto at = flat.instances.begin(); at != flat.instances.end(); at += kInstanceTexels) {
        std::array<uvec4, kInstanceTexels> texels{};
        std::copy_n(at, kInstanceTexels, texels.begin());
        instances.push_back(std::bit_cast<InstanceData>(texels));
    }
    std::vector<std::uint32_t> begins = {
        static_cast<std::uint32_t>(flat.primitiveRefs.size() / kPrimitiveRefTexels)};  // of the shared meshes' references, then their end
    for (const InstanceData& instance : instances) {
        begins.push_back(instance.beginRef - instance.firstRef);
    }
    std::ranges::sort(begins);
    visitRefs(0, begins.front(), std::identity());
    for (const InstanceData& instance : instances) {
        const std::uint32_t begin = instance.beginRef - instance.firstRef;
        visitRefs(begin, *std::ranges::upper_bound(begins, begin), [&](const Surface& surface) { return placed(surface, instance); });
    }
}

// Where rays of the camera begin.
Bounds boundOrigins(const FlatCamera& camera)
{
    const vec2 farthest = 1.0F + glm::abs(camera.projection.shift);
    const vec3 film = farthest.x * glm::abs(camera.right) + farthest.y * glm::abs(camera.up);
    const vec3 extent = glm::abs(camera.lensRight) + glm::abs(camera.lensUp) + (camera.kind == kOrthographic ? film : vec3(0.0F));
    return {glm::dvec3(camera.position - extent), glm::dvec3(camera.position + extent)};
}

// Where the ray along kOutwards crosses the surface of a solid.
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

// `center` is relative to the point, like the corners of addTriangle.
void addSphere(Surroundings& around, const glm::dvec3& center, double radius)
{
    const double along = glm::dot(glm::dvec3(kOutwards), center);
    const double inside = radius * radius - glm::dot(center, center), square = along * along + inside;
    around.winding += inside > 0.0 ? 1.0 : 0.0;
    if (square >= 0.0 && along + std::sqrt(square) > 0.0) {
        if (along - std::sqrt(square) > 0.0) {
            around.crossings.push_back({along - std::sqrt(square), true});
        }
        around.crossings.push_back({along + std::sqrt(square), false});
    }
}

// The distances at which the ray leaves the solids around the point, nearest first. Solids that the ray enters later are not among them.
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
    SolidFinder(const FlatScene& flat, const Bounds& origins)
        : flat_(flat),
          origins_(origins),
          middle_(0.5 * (origins.low + origins.high))
    {}

    // The media that the camera's rays begin in, as in FlatCamera::media.
    uint find()
    {
        std::map<uint, Bounds> bounds;  // of all solids of a medium
        forEachSurface(flat_, [&](const Surface& surface) {
            if (const uint medium = getMedium(surface); medium != 0) {
                bounds[medium].add(surface.bounds());
            }
        });
        std::erase_if(bounds, [&](const auto& entry) { return !touch(origins_, entry.second); });
        if (bounds.empty()) {
            return 0;
        }
        forEachSurface(flat_, [&](const Surface& surface) {
            if (const uint medium = getMedium(surface); bounds.contains(medium)) {
                add(surface, around_[medium]);
            }
        });
        return straddles_ ? kMediaVary : wordOf();
    }

private:
    uint getMedium(const Surface& surface) const { return flat_.mediumOfMaterial[surface.material]; }

    void add(const Surface& surface, Surroundings& around)
    {
        const auto& [a, b, c] = surface.corners;
        if (surface.isSphere) {
            addSphere(around, a - middle_, b.x);
        } else {
            addTriangle(around, a - middle_, b - middle_, c - middle_);
        }
        straddles_ = straddles_ || (surface.isSphere ? isSurfaceIn(a, b.x) : touch(origins_, surface.bounds()));
    }

    // Whether part of the sphere's surface lies among the points.
    bool isSurfaceIn(const glm::dvec3& center, double radius) const
    {
        const double nearest = glm::distance(center, glm::clamp(center, origins_.low, origins_.high));
        const double farthest = glm::length(glm::max(glm::abs(origins_.low - center), glm::abs(origins_.high - center)));
        return nearest <= radius && farthest >= radius;
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

    const FlatScene& flat_;
    const Bounds origins_;
    const glm::dvec3 middle_;
    std::map<uint, Surroundings> around_;  // by medium
    bool straddles_ = false;               // some points are inside of a solid, others are not
};

}  // namespace

FlatCamera placeInMedia(FlatCamera camera, const FlatScene& flat)
{
    const bool tracked = (flat.features & kFeatureMedia) != 0;
    if (tracked && (camera.motion != 0 || (flat.features & kFeatureMotion) != 0)) {
        camera.media = kMediaVary;
        return camera;
    }
    camera.media = tracked ? SolidFinder(flat, boundOrigins(camera)).find() : 0;
    return camera;
}

bool mayLightsBeInMedia(const FlatScene& flat)
{
    if ((flat.features & kFeatureMedia) == 0) {
        return false;
    }
    if ((flat.features & kFeatureMotion) != 0) {
        return true;
    }
    Bounds lit;  // around all lights: many cost no more than one
    for (const FlatLight& light : flat.lights) {
        const uint kind = light.kind & kLightKindMask;
        if (kind == kPointLight || kind == kSpotLight) {
            lit.add(glm::dvec3(light.position));
        }
    }
    forEachSurface(flat, [&](const Surface& surface) {
        if (flat.materials[surface.material].emission != vec3(0.0F)) {
            lit.add(surface.bounds());
        }
    });
    return SolidFinder(flat, lit).find() != 0;
}

}  // namespace glim
