#include "host/flatten/build_scene_bvh.hpp"

#include "host/bvh/collapse_bvh.hpp"
#include "host/flatten/split_triangles.hpp"

#include <cmath>
#include <limits>

namespace glim {
namespace {

// The tree over pieces is used if its cost is below this fraction of the other's. Of 17 scenes, pieces make rays faster in only one,
// which has .85; the others have .96 and more, and at .96 shadow rays take 1.7 times as long (tests/bench/EXPERIMENTS.md).
constexpr double kWorthwhile = 0.9;

// Rounded outwards.
Box boxOf(const Sphere& sphere)
{
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Box box{sphere.center - sphere.radius, sphere.center + sphere.radius};
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::nextafter(box.lo[k], -kInfinity);
        box.hi[k] = std::nextafter(box.hi[k], kInfinity);
    }
    return box;
}

}  // namespace

std::vector<Box> primitiveBoxes(const Primitives& primitives)
{
    std::vector<Box> boxes;
    boxes.reserve(primitives.count());
    for (const Triangle& t : primitives.triangles) {
        boxes.push_back({glm::min(t.vertices[0], glm::min(t.vertices[1], t.vertices[2])),
                         glm::max(t.vertices[0], glm::max(t.vertices[1], t.vertices[2]))});
    }
    for (const Sphere& sphere : primitives.spheres) {
        boxes.push_back(boxOf(sphere));
    }
    return boxes;
}

WideBvh buildSceneBvh(const Primitives& primitives, SplitRule rule)
{
    std::vector<Box> boxes = primitiveBoxes(primitives);
    WideBvh bvh = collapseBvh(buildBvh(boxes, rule));
    const Pieces pieces = rule == SplitRule::Sah ? splitTriangles(primitives.triangles, std::move(boxes)) : Pieces{};
    if (pieces.boxes.empty()) {
        return bvh;
    }
    WideBvh ofPieces = collapseBvh(buildBvh(pieces.boxes, rule));
    if (!(ofPieces.cost < kWorthwhile * bvh.cost)) {
        return bvh;
    }
    for (std::uint32_t& piece : ofPieces.order) {
        piece = pieces.primitives[piece];
    }
    ofPieces.box = bvh.box;  // without the pieces' margin
    return ofPieces;
}

}  // namespace glim
