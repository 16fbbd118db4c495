// Parts of large clouds. The tree of each is built alone, so that what building takes is never there for all points at once.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// Building a tree takes some 150 bytes a point. Rays in smaller parts are slower: parts of 2^16 points cost a twentieth.
inline constexpr std::size_t kMaxPointsInPart = 1U << 18U;

class PointParts {
public:
    // Nothing is in parts if one could hold all points. The same on any number of threads.
    PointParts(const Primitives& primitives, SplitRule rule);

    bool empty() const { return points_.empty(); }
    std::size_t count() const { return leaves_.size(); }
    std::size_t pointCount() const { return points_.size(); }
    const std::vector<std::uint32_t>& others() const { return others_; }
    const Box& getBox(std::size_t part) const { return leaves_[part].box; }
    // Its `order` has primitives. At most kMaxDepthOfEntry levels.
    WideBvh buildTree(std::size_t part) const { return buildTree(part, rule_); }

private:
    WideBvh buildTree(std::size_t part, SplitRule rule) const;

    const Primitives& primitives_;
    const SplitRule rule_;
    std::vector<std::uint32_t> points_;  // primitives, part after part
    std::vector<BvhNode> leaves_;        // the parts
    std::vector<std::uint32_t> others_;  // primitives that are in no part, if there are parts
};

}  // namespace glim
