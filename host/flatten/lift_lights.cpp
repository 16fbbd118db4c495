#include "host/flatten/lift_lights.hpp"

#include "host/bvh/bvh.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace glim {
namespace {

constexpr std::size_t kMaxComparisons = 100'000'000;
constexpr std::size_t kCostOfPair = 64;  // whose boxes overlap, in comparisons
constexpr float kCoplanar = 0x1p-22F;    // of the coordinates: two roundings
constexpr float kLift = 0x1p-18F;        // of the coordinates: what a hit at a grazing angle of .1 is off by

Box boxOf(const Triangle& triangle)
{
    const auto& [a, b, c] = triangle.vertices;
    return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

float longestSide(const Box& box)
{
    const glm::vec3 size = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    return std::max({size.x, size.y, size.z});
}

bool overlap(const Box& a, const Box& b, float slack)
{
    return a.lo.x <= b.hi.x + slack && b.lo.x <= a.hi.x + slack && a.lo.y <= b.hi.y + slack && b.lo.y <= a.hi.y + slack &&
           a.lo.z <= b.hi.z + slack && b.lo.z <= a.hi.z + slack;
}

// Whether the triangles touch more than at an edge: some direction in the plane, across an edge of either, would tell them apart.
bool overlapInPlane(const Triangle& a, const Triangle& b, const glm::dvec3& normal, double slack)
{
    for (const Triangle* of : {&a, &b}) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 from(of->vertices[i]);
            const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(of->vertices[(i + 1) % 3]) - from));
            const auto getRange = [&](const Triangle& triangle) {
                std::array<double, 3> at{};
                for (std::size_t v = 0; v < 3; ++v) {
                    at[v] = glm::dot(across, glm::dvec3(triangle.vertices[v]) - from);
                }
                return std::pair(*std::ranges::min_element(at), *std::ranges::max_element(at));
            };
            const auto [aLow, aHigh] = getRange(a);
            const auto [bLow, bHigh] = getRange(b);
            if (std::min(aHigh, bHigh) - std::max(aLow, bLow) <= slack) {
                return false;
            }
        }
    }
    return true;
}

// How far the light must move, or 0, if their boxes overlap.
float computeLift(const Triangle& light, const Box& box, const Triangle& other, const Box& otherBox)
{
    const float size = std::max(longestSide(box), longestSide(otherBox));
    const double slack = static_cast<double>(kCoplanar * size);
    const glm::dvec3 normal = glm::normalize(faceNormal(light)), at(light.vertices[0]);
    const bool coplanar =
        std::ranges::all_of(other.vertices, [&](const glm::vec3& v) { return std::abs(glm::dot(normal, glm::dvec3(v) - at)) <= slack; });
    return coplanar && overlapInPlane(light, other, normal, 4.0 * slack) ? kLift * size : 0.0F;
}

bool emits(const Material& material) { return material.emission != glm::vec3(0.0F); }

bool transmitsLight(const Material& material) { return material.transmission > 0.0F || material.diffuseTransmission > 0.0F; }

bool isSeenFromBehind(const Material& material) { return material.doubleSided || transmitsLight(material); }

const Material& getMaterial(const Scene& scene, const MeshInstance& instance)
{
    return scene.materials[scene.meshes[instance.mesh].material];
}

const Material& getMaterial(const Scene& scene, const Primitives& primitives, std::uint32_t triangle)
{
    return getMaterial(scene, scene.instances[primitives.findInstance(triangle)]);
}

std::vector<std::uint32_t> findEmitting(const Scene& scene, const Primitives& primitives)
{
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        for (std::uint32_t t = primitives.firstTriangles[i];
             emits(getMaterial(scene, scene.instances[i])) && t < primitives.firstTriangles[i + 1]; ++t) {
            found.push_back(t);
        }
    }
    return found;
}

// What becomes of triangles: copies moved by these vectors, or nothing.
using Copies = std::map<std::uint32_t, std::vector<glm::vec3>>;

// In the order of the old triangles. Those that are not named stay.
void replaceTriangles(Primitives& primitives, const Copies& copies)
{
    const std::vector<Triangle> triangles = std::exchange(primitives.triangles, {});
    const std::vector<glm::uvec3> vertexIndices = std::exchange(primitives.vertexIndices, {});
    const std::vector<bool> hasAlpha = std::exchange(primitives.hasAlpha, {});
    const std::vector<std::uint32_t> ends = std::exchange(primitives.firstTriangles, {0});
    const std::vector<glm::vec3> stays = {glm::vec3(0.0F)};
    auto next = copies.begin();
    for (std::uint32_t i = 0, instance = 1; instance < ends.size(); ++instance) {
        for (; i < ends[instance]; ++i) {
            const bool named = next != copies.end() && next->first == i;
            for (const glm::vec3& by : named ? (next++)->second : stays) {
                Triangle triangle = triangles[i];
                for (glm::vec3& vertex : triangle.vertices) {
                    vertex += by;
                }
                primitives.triangles.push_back(triangle);
                if (!vertexIndices.empty()) {
                    primitives.vertexIndices.push_back(vertexIndices[i]);
                }
                if (!hasAlpha.empty()) {
                    primitives.hasAlpha.push_back(hasAlpha[i]);
                }
            }
        }
        primitives.firstTriangles.push_back(static_cast<std::uint32_t>(primitives.triangles.size()));
    }
    for (std::size_t i = triangles.size(); i < hasAlpha.size(); ++i) {
        primitives.hasAlpha.push_back(hasAlpha[i]);  // of the spheres
    }
}

// The same for the same vertices in any order.
std::uint64_t hashTriangle(const Triangle& triangle)
{
    std::uint64_t sum = 0;
    for (const glm::vec3& vertex : triangle.vertices) {
        std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a, a word at a time
        for (int axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(vertex[axis] + 0.0F)) * 1099511628211ULL;  // -0 as 0
        }
        sum += hash ^ hash >> 29U;
    }
    return sum;
}

// Emitting triangles with the vertices of one before them that hides them.
Copies findHidden(const Scene& scene, const Primitives& primitives)
{
    std::vector<std::pair<std::uint64_t, std::uint32_t>> lights;
    for (const std::uint32_t light : findEmitting(scene, primitives)) {
        lights.emplace_back(hashTriangle(primitives.triangles[light]), light);
    }
    std::ranges::sort(lights);
    const auto hides = [&](std::uint32_t first, std::uint32_t second) {
        const Triangle &a = primitives.triangles[first], &b = primitives.triangles[second];
        const bool sameFront = glm::dot(faceNormal(a), faceNormal(b)) > 0.0;
        return std::ranges::is_permutation(a.vertices, b.vertices) &&
               (isSeenFromBehind(getMaterial(scene, primitives, first)) ||
                (sameFront && !isSeenFromBehind(getMaterial(scene, primitives, second))));
    };
    Copies hidden;
    constexpr std::size_t kMaxStanding = 8;  // at one place: one to each side and one to both; more by chance
    std::vector<std::uint32_t> standing;     // opaque ones of one hash
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (i == 0 || lights[i].first != lights[i - 1].first) {
            standing.clear();
        }
        const std::uint32_t light = lights[i].second;
        if (std::ranges::any_of(standing, [&](std::uint32_t first) { return hides(first, light); })) {
            hidden[light];
        } else if (standing.size() < kMaxStanding && (primitives.hasAlpha.empty() || !primitives.hasAlpha[light])) {
            standing.push_back(light);
        }
    }
    return hidden;
}

// Of coincident spheres a ray meets the one with the lowest index. Emitting opaque spheres therefore take the lower indices, but not before
// a sphere with alpha. Spheres that they hide are left out. Returns how many.
std::size_t placeSpheres(const Scene& scene, Primitives& primitives)
{
    if (std::ranges::none_of(primitives.spheres.all(),
                             [&](const PlacedSphere& sphere) { return emits(scene.materials[sphere.material]); })) {
        return 0;
    }
    using Place = std::array<float, 7>;
    const PlacedSpheres& spheres = primitives.spheres;
    const std::vector<bool> hasAlpha(primitives.hasAlpha);
    const std::size_t triangles = primitives.triangles.size();
    const auto placeOf = [&](std::size_t i) {
        const PlacedSphere sphere = spheres[i];
        const auto& [center, axis] = std::tie(sphere.center, sphere.axis);
        return Place{center.x, center.y, center.z, sphere.radius, axis.x, axis.y, axis.z};
    };
    const auto isClear = [&](std::size_t i) { return !hasAlpha.empty() && hasAlpha[triangles + i]; };
    const auto isLight = [&](std::size_t i) { return emits(scene.materials[spheres[i].material]) && !isClear(i); };
    const auto isTwoSided = [&](std::size_t i) { return isSeenFromBehind(scene.materials[spheres[i].material]); };
    std::vector<std::uint32_t> order(spheres.size());
    std::iota(order.begin(), order.end(), 0U);
    std::map<Place, std::uint32_t> firstLights;
    for (const std::uint32_t i : order) {
        if (isLight(i)) {
            firstLights.try_emplace(placeOf(i), i);
        }
    }
    std::map<Place, std::vector<std::uint32_t>> groups;
    for (const std::uint32_t i : order) {
        if (const auto light = firstLights.find(placeOf(i)); light != firstLights.end() && !(isClear(i) && i < light->second)) {
            groups[light->first].push_back(i);
        }
    }
    constexpr auto kLeftOut = std::numeric_limits<std::uint32_t>::max();
    for (const auto& [place, slots] : groups) {
        std::vector<std::uint32_t> group = slots, kept;
        std::ranges::stable_partition(group, isLight);
        std::ranges::copy_if(group, std::back_inserter(kept), [&](std::uint32_t i) {
            return std::ranges::none_of(kept,
                                        [&](std::uint32_t before) { return isLight(before) && (isTwoSided(before) || !isTwoSided(i)); });
        });
        kept.resize(slots.size(), kLeftOut);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            order[slots[k]] = kept[k];
        }
    }
    std::erase(order, kLeftOut);
    primitives.hasAlpha.resize(hasAlpha.empty() ? 0 : triangles);
    for (const std::uint32_t i : order) {
        if (!hasAlpha.empty()) {
            primitives.hasAlpha.push_back(isClear(i));
        }
    }
    const std::size_t leftOut = spheres.size() - order.size();
    primitives.spheres.select(std::move(order));
    return leftOut;
}

// A light and another triangle that overlap in one plane.
struct Overlap {
    std::uint32_t light, other;
    float lift;
};

// Each triangle is compared with the lights that begin near it along one axis. Nothing if there are too many to compare.
std::vector<Overlap> findOverlaps(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& lights)
{
    struct SortedLight {
        float begin;
        std::uint32_t triangle;
        Box box;
    };
    std::vector<SortedLight> sorted;
    Box all = boxOf(triangles[lights[0]]);
    for (const std::uint32_t light : lights) {
        const Box box = boxOf(triangles[light]);
        all = {glm::min(all.lo, box.lo), glm::max(all.hi, box.hi)};
        sorted.push_back({0.0F, light, box});
    }
    const glm::vec3 extent = all.hi - all.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    float widest = 0.0F;
    for (SortedLight& light : sorted) {
        light.begin = light.box.lo[axis];
        widest = std::max(widest, light.box.hi[axis] - light.begin);
    }
    std::ranges::sort(sorted, {}, [](const SortedLight& light) { return std::pair(light.begin, light.triangle); });
    const float lightSize = longestSide(all);
    std::vector<Overlap> overlaps;
    std::size_t comparisons = 0;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Box box = boxOf(triangles[i]);
        const float slack = 2.0F * kCoplanar * std::max(lightSize, longestSide(box));
        const auto first = std::ranges::lower_bound(sorted, box.lo[axis] - widest - slack, {}, &SortedLight::begin);
        const auto end = std::ranges::upper_bound(sorted, box.hi[axis] + slack, {}, &SortedLight::begin);
        comparisons += static_cast<std::size_t>(std::max(end - first, std::ptrdiff_t{0}));
        for (auto light = first; light < end; ++light) {
            if (overlap(light->box, box, slack) && light->triangle != i &&
                overlap(light->box, box, kCoplanar * std::max(longestSide(light->box), longestSide(box)))) {
                comparisons += kCostOfPair;
                const float lift = computeLift(triangles[light->triangle], light->box, triangles[i], box);
                if (lift > 0.0F) {
                    overlaps.push_back({light->triangle, i, lift});
                }
            }
        }
        if (comparisons > kMaxComparisons) {
            return {};
        }
    }
    return overlaps;
}

// What the lights become: from the last one to the first, each above those that it must hide.
Copies stackLights(const Scene& scene, const Primitives& primitives, std::vector<Overlap> overlaps,
                   const std::vector<std::uint32_t>& lights)
{
    struct Sides {
        float front = 0.0F, back = 0.0F;
    };
    std::ranges::sort(overlaps, std::greater(), [](const Overlap& overlap) { return std::pair(overlap.light, overlap.other); });
    std::map<std::uint32_t, Sides> lifts;
    for (const Overlap& overlap : overlaps) {
        const bool sameFront =
            glm::dot(faceNormal(primitives.triangles[overlap.light]), faceNormal(primitives.triangles[overlap.other])) > 0.0;
        const bool isLight = std::ranges::binary_search(lights, overlap.other), isFirst = overlap.light < overlap.other;
        const bool twoSided = getMaterial(scene, primitives, overlap.light).doubleSided;
        const bool otherTwoSided = isLight && getMaterial(scene, primitives, overlap.other).doubleSided;
        const auto other = lifts.find(overlap.other);
        const Sides below = other == lifts.end() ? Sides() : other->second;
        // Against a light that shines to the same side, the first one is above it.
        const auto raise = [&](float& lift, bool otherShines, float otherLift) {
            if (!otherShines || isFirst) {
                lift = std::max(lift, (otherShines ? otherLift : 0.0F) + overlap.lift);
            }
        };
        Sides sides = lifts[overlap.light];
        raise(sides.front, isLight && (sameFront || otherTwoSided), sameFront ? below.front : below.back);
        if (twoSided) {
            raise(sides.back, isLight && (!sameFront || otherTwoSided), sameFront ? below.back : below.front);
        }
        lifts[overlap.light] = sides;
    }
    Copies copies;
    for (const auto& [light, sides] : lifts) {
        const glm::dvec3 normal = glm::normalize(faceNormal(primitives.triangles[light]));
        if (sides.front > 0.0F || sides.back > 0.0F) {
            copies[light] = {glm::vec3(static_cast<double>(sides.front) * normal)};
        }
        if (sides.back > 0.0F) {
            copies[light].emplace_back(static_cast<double>(-sides.back) * normal);
        }
    }
    return copies;
}

float largestStep(const Copies& copies)
{
    float largest = 0.0F;
    for (const auto& [triangle, steps] : copies) {
        for (const glm::vec3& step : steps) {
            largest = std::max(largest, glm::length(step));
        }
    }
    return largest;
}

}  // namespace

void liftLights(const Scene& scene, Primitives& primitives)
{
    const Copies hidden = findHidden(scene, primitives);
    if (!hidden.empty()) {
        replaceTriangles(primitives, hidden);
        primitives.warnings.push_back(
            {MessageId::HiddenLight,
             {"left out ", part::value(counted(hidden.size(), "emitting triangle")), " in the same place as another"}});
    }
    if (const std::size_t count = placeSpheres(scene, primitives); count > 0) {
        primitives.warnings.push_back(
            {MessageId::HiddenLight, {"left out ", part::value(counted(count, "sphere")), " in the same place as one that emits"}});
    }
    std::vector<std::uint32_t> lights = findEmitting(scene, primitives);
    std::erase_if(lights, [&](std::uint32_t light) {
        const Material& material = getMaterial(scene, primitives, light);
        const bool isClear = transmitsLight(material) || (!primitives.hasAlpha.empty() && primitives.hasAlpha[light]);
        return material.textures[kSlotEmissive] || (material.doubleSided && isClear);
    });
    if (lights.empty()) {
        return;
    }
    const auto moved = stackLights(scene, primitives, findOverlaps(primitives.triangles, lights), lights);
    if (!moved.empty()) {
        replaceTriangles(primitives, moved);
        primitives.warnings.push_back(
            {MessageId::LiftedLight,
             {part::value(counted(moved.size(), "emitting triangle")), " in the plane of another surface: moved by up to ",
              exactText(largestStep(moved)), " m to their front"}});
    }
}

}  // namespace glim
