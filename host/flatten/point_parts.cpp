#include "host/flatten/point_parts.hpp"

#include "host/bvh/collapse_bvh.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <thread>

namespace glim {
namespace {

bool isPoint(const PlacedSphere& sphere) { return sphere.point != kNoIndex && !sphere.isLine(); }

}  // namespace

PointParts::PointParts(const Primitives& primitives, SplitRule rule)
    : primitives_(primitives),
      rule_(rule)
{
    if (primitives.spheres.size() <= kMaxPointsInPart) {
        return;
    }
    const auto count = static_cast<std::size_t>(std::ranges::count_if(primitives.spheres.all(), isPoint));
    if (count <= kMaxPointsInPart) {
        return;
    }
    std::vector<Box> boxes;
    boxes.reserve(count);
    points_.reserve(count);
    const auto triangles = static_cast<std::uint32_t>(primitives.triangles.size());
    for (std::uint32_t id = 0; id < primitives.count(); ++id) {
        const PlacedSphere sphere = id < triangles ? PlacedSphere() : primitives.spheres[id - triangles];
        if (isPoint(sphere)) {
            points_.push_back(id);
            boxes.push_back(computeBox(sphere));
        } else {
            others_.push_back(id);
        }
    }
    const Bvh top = divide(std::move(boxes), rule, std::thread::hardware_concurrency(), kMaxPointsInPart);
    std::ranges::copy_if(top.nodes, std::back_inserter(leaves_), [](const BvhNode& node) { return node.count > 0; });
    std::vector<std::uint32_t> ordered(count);
    std::ranges::transform(top.order, ordered.begin(), [&](std::uint32_t point) { return points_[point]; });
    points_ = std::move(ordered);
}

WideBvh PointParts::buildTree(std::size_t part, SplitRule rule) const
{
    const auto points = std::span(points_).subspan(leaves_[part].first, leaves_[part].count);
    std::vector<Box> boxes;
    boxes.reserve(points.size());
    for (const std::uint32_t id : points) {
        boxes.push_back(computeBox(primitives_.spheres[id - primitives_.triangles.size()]));
    }
    WideBvh tree = collapseBvh(buildBvh(std::move(boxes), rule));
    if (tree.depth > kMaxDepthOfEntry) {
        return buildTree(part, SplitRule::Median);
    }
    for (std::uint32_t& entry : tree.order) {
        entry = points[entry];
    }
    return tree;
}

}  // namespace glim
