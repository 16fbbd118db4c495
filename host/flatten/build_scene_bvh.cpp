#include "host/flatten/build_scene_bvh.hpp"

#include "host/bvh/widen_bvh.hpp"
#include "host/flatten/split_triangles.hpp"

#include <cmath>
#include <limits>

namespace glim {
namespace {

// Of the costs. The tree of pieces that makes rays faster costs .85 of the other, and those of 16 other scenes .96 and more: at .96 rays
// into the shadow take 1.7 times as long (tests/bench/README.md).
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

std::vector<Box> primitiveBoxes(const Scene& scene)
{
    std::vector<Box> boxes;
    boxes.reserve(scene.triangles.size() + scene.spheres.size());
    for (const Triangle& t : scene.triangles) {
        boxes.push_back({glm::min(t.vertices[0], glm::min(t.vertices[1], t.vertices[2])),
                         glm::max(t.vertices[0], glm::max(t.vertices[1], t.vertices[2]))});
    }
    for (const Sphere& sphere : scene.spheres) {
        boxes.push_back(boxOf(sphere));
    }
    return boxes;
}

WideBvh buildSceneBvh(const Scene& scene, SplitRule rule)
{
    std::vector<Box> boxes = primitiveBoxes(scene);
    WideBvh bvh = widenBvh(buildBvh(boxes, rule));
    const Pieces pieces = rule == SplitRule::Sah ? splitTriangles(scene, std::move(boxes)) : Pieces{};
    if (pieces.boxes.empty()) {
        return bvh;
    }
    WideBvh ofPieces = widenBvh(buildBvh(pieces.boxes, rule));
    if (!(ofPieces.cost < kWorthwhile * bvh.cost)) {
        return bvh;
    }
    for (std::uint32_t& piece : ofPieces.order) {
        piece = pieces.primitives[piece];
    }
    ofPieces.box = bvh.box;  // the scene's, without the margin of pieces
    return ofPieces;
}

}  // namespace glim
