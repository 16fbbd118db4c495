#include "host/flatten/lift_lamps.hpp"

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

constexpr std::size_t kMostComparisons = 100'000'000;
constexpr std::size_t kCostOfPair = 64;  // whose boxes overlap, in comparisons
constexpr float kCoplanar = 0x1p-22F;    // of the coordinates: two roundings
constexpr float kLift = 0x1p-18F;        // of the coordinates: what a hit at a grazing angle of .1 is off by

Box boxOf(const Triangle& triangle)
{
    const auto& [a, b, c] = triangle.vertices;
    return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
}

float sizeOf(const Box& box)
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

// How far the lamp must move, or 0, if their boxes overlap.
float liftOf(const Triangle& lamp, const Box& box, const Triangle& other, const Box& otherBox)
{
    const float size = std::max(sizeOf(box), sizeOf(otherBox));
    const double slack = static_cast<double>(kCoplanar * size);
    const glm::dvec3 normal = glm::normalize(faceNormal(lamp)), at(lamp.vertices[0]);
    const bool coplanar =
        std::ranges::all_of(other.vertices, [&](const glm::vec3& v) { return std::abs(glm::dot(normal, glm::dvec3(v) - at)) <= slack; });
    return coplanar && overlapInPlane(lamp, other, normal, 4.0 * slack) ? kLift * size : 0.0F;
}

bool emits(const Material& material) { return material.emission != glm::vec3(0.0F); }

bool isPassed(const Material& material) { return material.transmission > 0.0F || material.diffuseTransmission > 0.0F; }

bool isSeenFromBehind(const Material& material) { return material.doubleSided || isPassed(material); }

const Material& materialOf(const Scene& scene, const MeshInstance& instance)
{
    return scene.materials[scene.meshes[instance.mesh].material];
}

const Material& materialOf(const Scene& scene, const Primitives& primitives, std::uint32_t triangle)
{
    return materialOf(scene, scene.instances[primitives.instanceOf(triangle)]);
}

std::vector<std::uint32_t> findEmitting(const Scene& scene, const Primitives& primitives)
{
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        for (std::uint32_t t = primitives.firstTriangles[i];
             emits(materialOf(scene, scene.instances[i])) && t < primitives.firstTriangles[i + 1]; ++t) {
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
std::uint64_t hashOf(const Triangle& triangle)
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
    std::vector<std::pair<std::uint64_t, std::uint32_t>> lamps;
    for (const std::uint32_t lamp : findEmitting(scene, primitives)) {
        lamps.emplace_back(hashOf(primitives.triangles[lamp]), lamp);
    }
    std::ranges::sort(lamps);
    const auto hides = [&](std::uint32_t first, std::uint32_t second) {
        const Triangle &a = primitives.triangles[first], &b = primitives.triangles[second];
        const bool sameFront = glm::dot(faceNormal(a), faceNormal(b)) > 0.0;
        return std::ranges::is_permutation(a.vertices, b.vertices) &&
               (isSeenFromBehind(materialOf(scene, primitives, first)) ||
                (sameFront && !isSeenFromBehind(materialOf(scene, primitives, second))));
    };
    Copies hidden;
    constexpr std::size_t kMostStanding = 8;  // at one place: one to each side and one to both; more by chance
    std::vector<std::uint32_t> standing;      // opaque ones of one hash
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        if (i == 0 || lamps[i].first != lamps[i - 1].first) {
            standing.clear();
        }
        const std::uint32_t lamp = lamps[i].second;
        if (std::ranges::any_of(standing, [&](std::uint32_t first) { return hides(first, lamp); })) {
            hidden[lamp];
        } else if (standing.size() < kMostStanding && (primitives.hasAlpha.empty() || !primitives.hasAlpha[lamp])) {
            standing.push_back(lamp);
        }
    }
    return hidden;
}

// Of coincident spheres a ray meets the one with the lowest index. Emitting opaque spheres therefore take the lower indices, but not before
// a sphere with alpha. Spheres that they hide are left out. Returns how many.
std::size_t placeSpheres(const Scene& scene, Primitives& primitives)
{
    using Place = std::array<float, 4>;
    const std::vector<Sphere> spheres = std::exchange(primitives.spheres, {});
    const std::vector<bool> hasAlpha(primitives.hasAlpha);
    const std::size_t triangles = primitives.triangles.size();
    const auto placeOf = [&](std::size_t i) {
        return Place{spheres[i].center.x, spheres[i].center.y, spheres[i].center.z, spheres[i].radius};
    };
    const auto isClear = [&](std::size_t i) { return !hasAlpha.empty() && hasAlpha[triangles + i]; };
    const auto isLamp = [&](std::size_t i) { return emits(scene.materials[spheres[i].material]) && !isClear(i); };
    const auto isTwoSided = [&](std::size_t i) { return isSeenFromBehind(scene.materials[spheres[i].material]); };
    std::vector<std::size_t> order(spheres.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::map<Place, std::size_t> firstLamps;
    for (const std::size_t i : order) {
        if (isLamp(i)) {
            firstLamps.try_emplace(placeOf(i), i);
        }
    }
    std::map<Place, std::vector<std::size_t>> groups;
    for (const std::size_t i : order) {
        if (const auto lamp = firstLamps.find(placeOf(i)); lamp != firstLamps.end() && !(isClear(i) && i < lamp->second)) {
            groups[lamp->first].push_back(i);
        }
    }
    constexpr auto kLeftOut = std::numeric_limits<std::size_t>::max();
    for (const auto& [place, slots] : groups) {
        std::vector<std::size_t> group = slots, kept;
        std::ranges::stable_partition(group, isLamp);
        std::ranges::copy_if(group, std::back_inserter(kept), [&](std::size_t i) {
            return std::ranges::none_of(kept, [&](std::size_t before) { return isLamp(before) && (isTwoSided(before) || !isTwoSided(i)); });
        });
        kept.resize(slots.size(), kLeftOut);
        for (std::size_t k = 0; k < slots.size(); ++k) {
            order[slots[k]] = kept[k];
        }
    }
    std::erase(order, kLeftOut);
    primitives.hasAlpha.resize(hasAlpha.empty() ? 0 : triangles);
    for (const std::size_t i : order) {
        primitives.spheres.push_back(spheres[i]);
        if (!hasAlpha.empty()) {
            primitives.hasAlpha.push_back(isClear(i));
        }
    }
    return spheres.size() - order.size();
}

// A lamp and another triangle that overlap in one plane.
struct Overlap {
    std::uint32_t lamp, other;
    float lift;
};

// Each triangle is compared with the lamps that begin near it along one axis. Nothing if there are too many to compare.
std::vector<Overlap> findOverlaps(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& lamps)
{
    struct Lamp {
        float begin;
        std::uint32_t triangle;
        Box box;
    };
    std::vector<Lamp> sorted;
    Box all = boxOf(triangles[lamps[0]]);
    for (const std::uint32_t lamp : lamps) {
        const Box box = boxOf(triangles[lamp]);
        all = {glm::min(all.lo, box.lo), glm::max(all.hi, box.hi)};
        sorted.push_back({0.0F, lamp, box});
    }
    const glm::vec3 extent = all.hi - all.lo;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    float widest = 0.0F;
    for (Lamp& lamp : sorted) {
        lamp.begin = lamp.box.lo[axis];
        widest = std::max(widest, lamp.box.hi[axis] - lamp.begin);
    }
    std::ranges::sort(sorted, {}, [](const Lamp& lamp) { return std::pair(lamp.begin, lamp.triangle); });
    const float lampSize = sizeOf(all);
    std::vector<Overlap> overlaps;
    std::size_t comparisons = 0;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Box box = boxOf(triangles[i]);
        const float slack = 2.0F * kCoplanar * std::max(lampSize, sizeOf(box));
        const auto first = std::ranges::lower_bound(sorted, box.lo[axis] - widest - slack, {}, &Lamp::begin);
        const auto end = std::ranges::upper_bound(sorted, box.hi[axis] + slack, {}, &Lamp::begin);
        comparisons += static_cast<std::size_t>(std::max(end - first, std::ptrdiff_t{0}));
        for (auto lamp = first; lamp < end; ++lamp) {
            if (overlap(lamp->box, box, slack) && lamp->triangle != i &&
                overlap(lamp->box, box, kCoplanar * std::max(sizeOf(lamp->box), sizeOf(box)))) {
                comparisons += kCostOfPair;
                const float lift = liftOf(triangles[lamp->triangle], lamp->box, triangles[i], box);
                if (lift > 0.0F) {
                    overlaps.push_back({lamp->triangle, i, lift});
                }
            }
        }
        if (comparisons > kMostComparisons) {
            return {};
        }
    }
    return overlaps;
}

// What the lamps become: from the last one to the first, each above those that it must hide.
Copies placeLamps(const Scene& scene, const Primitives& primitives, std::vector<Overlap> overlaps, const std::vector<std::uint32_t>& lamps)
{
    struct Sides {
        float front = 0.0F, back = 0.0F;
    };
    std::ranges::sort(overlaps, std::greater(), [](const Overlap& overlap) { return std::pair(overlap.lamp, overlap.other); });
    std::map<std::uint32_t, Sides> lifts;
    for (const Overlap& overlap : overlaps) {
        const bool sameFront =
            glm::dot(faceNormal(primitives.triangles[overlap.lamp]), faceNormal(primitives.triangles[overlap.other])) > 0.0;
        const bool isLamp = std::ranges::binary_search(lamps, overlap.other), isFirst = overlap.lamp < overlap.other;
        const bool twoSided = materialOf(scene, primitives, overlap.lamp).doubleSided;
        const bool otherTwoSided = isLamp && materialOf(scene, primitives, overlap.other).doubleSided;
        const auto other = lifts.find(overlap.other);
        const Sides below = other == lifts.end() ? Sides() : other->second;
        // Against a lamp that shines to the same side, the first one is above it.
        const auto raise = [&](float& lift, bool otherShines, float otherLift) {
            if (!otherShines || isFirst) {
                lift = std::max(lift, (otherShines ? otherLift : 0.0F) + overlap.lift);
            }
        };
        Sides sides = lifts[overlap.lamp];
        raise(sides.front, isLamp && (sameFront || otherTwoSided), sameFront ? below.front : below.back);
        if (twoSided) {
            raise(sides.back, isLamp && (!sameFront || otherTwoSided), sameFront ? below.back : below.front);
        }
        lifts[overlap.lamp] = sides;
    }
    Copies copies;
    for (const auto& [lamp, sides] : lifts) {
        const glm::dvec3 normal = glm::normalize(faceNormal(primitives.triangles[lamp]));
        if (sides.front > 0.0F || sides.back > 0.0F) {
            copies[lamp] = {glm::vec3(static_cast<double>(sides.front) * normal)};
        }
        if (sides.back > 0.0F) {
            copies[lamp].emplace_back(static_cast<double>(-sides.back) * normal);
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

void liftLamps(const Scene& scene, Primitives& primitives)
{
    const Copies hidden = findHidden(scene, primitives);
    if (!hidden.empty()) {
        replaceTriangles(primitives, hidden);
        primitives.warnings.push_back("left out " + counted(hidden.size(), "emitting triangle") + " in the same place as another");
    }
    if (const std::size_t count = placeSpheres(scene, primitives); count > 0) {
        primitives.warnings.push_back("left out " + counted(count, "sphere") + " in the same place as one that emits");
    }
    std::vector<std::uint32_t> lamps = findEmitting(scene, primitives);
    std::erase_if(lamps, [&](std::uint32_t lamp) {
        const Material& material = materialOf(scene, primitives, lamp);
        const bool isClear = isPassed(material) || (!primitives.hasAlpha.empty() && primitives.hasAlpha[lamp]);
        return material.textures[kSlotEmissive] || (material.doubleSided && isClear);
    });
    if (lamps.empty()) {
        return;
    }
    const auto moved = placeLamps(scene, primitives, findOverlaps(primitives.triangles, lamps), lamps);
    if (!moved.empty()) {
        replaceTriangles(primitives, moved);
        primitives.warnings.push_back(counted(moved.size(), "emitting triangle") + " in the plane of another surface: moved by up to " +
                                      exactText(largestStep(moved)) + " m to their front");
    }
}

}  // namespace glim
