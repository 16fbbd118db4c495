#include "host/bvh/examine_subtrees.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/bvh/surface_area.hpp"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <limits>

namespace glim {
namespace {

// The cost of a primitive test (3 texels) relative to a node visit (5 texels, eight boxes). A guess from these counts, not yet measured.
constexpr float kPrimitiveCost = 0.5F;

// The cheapest way to share out the roots, and how many of them are then below the left child.
struct RootShare {
    float cost;
    std::uint8_t toLeft;
};

RootShare shareRoots(const Subtree& left, const Subtree& right, std::uint32_t roots)
{
    RootShare best{std::numeric_limits<float>::infinity(), 1};
    for (std::uint32_t k = 1; k < roots; ++k) {
        const std::uint32_t l = std::min(k, kMaxRoots), r = std::min(roots - k, kMaxRoots);
        const float cost = left.cost[l - 1] + right.cost[r - 1];
        if (cost < best.cost) {
            best = {cost, static_cast<std::uint8_t>(k)};
        }
    }
    return best;
}

Subtree makeLeaf(const BvhNode& node, bool hasInstance)
{
    Subtree subtree{};
    subtree.cost.fill(static_cast<float>(computeHalfArea(node.box)) * static_cast<float>(node.count) * kPrimitiveCost);
    subtree.isLeaf = true;
    subtree.hasInstance = hasInstance;
    subtree.first = node.first;
    subtree.count = node.count;
    return subtree;
}

Subtree join(const BvhNode& node, const Subtree& left, const Subtree& right)
{
    Subtree subtree{};
    subtree.first = left.first;
    subtree.count = left.count + right.count;
    const auto area = static_cast<float>(computeHalfArea(node.box));
    subtree.hasInstance = left.hasInstance || right.hasInstance;
    const float asLeaf = subtree.count <= kMaxLeafRefs && !subtree.hasInstance ? area * static_cast<float>(subtree.count) * kPrimitiveCost
                                                                               : std::numeric_limits<float>::infinity();
    subtree.height = static_cast<std::uint8_t>(1 + std::max(left.height, right.height));
    const RootShare asNode = shareRoots(left, right, kBvhWidth);
    subtree.nodeToLeft = asNode.toLeft;
    subtree.isLeaf = asLeaf <= asNode.cost + area;
    subtree.cost[0] = std::min(asLeaf, asNode.cost + area);
    for (std::uint32_t roots = 2; roots <= kMaxRoots; ++roots) {
        const RootShare share = shareRoots(left, right, roots);
        const bool pays = share.cost < subtree.cost[roots - 2];
        subtree.cost[roots - 1] = pays ? share.cost : subtree.cost[roots - 2];
        subtree.toLeft[roots - 1] = pays ? share.toLeft : 0;
    }
    return subtree;
}

// A subtree: its root `node`, and nodes [begin, end) below it, which are contiguous because bvh.hpp demands depth-first order.
struct Part {
    std::uint32_t node, begin, end;
};

class Examiner {
public:
    Examiner(const Bvh& bvh, unsigned threads, std::uint32_t firstInstance)
        : bvh_(bvh),
          threads_(threads),
          firstInstance_(firstInstance),
          subtrees_(bvh.nodes.size())
    {}

    std::vector<Subtree> examine()
    {
        collectParts({0, 1, static_cast<std::uint32_t>(bvh_.nodes.size())});
        parallelFor(parts_.size(), threads_, [&](std::size_t i) {
            const Part& part = parts_[i];
            for (std::uint32_t node = part.end; node-- > part.begin;) {
                examine(node);
            }
            examine(part.node);
        });
        for (std::size_t i = top_.size(); i-- > 0;) {
            examine(top_[i]);
        }
        return std::move(subtrees_);
    }

private:
    void collectParts(const Part& part)
    {
        constexpr std::uint32_t kMaxNodesPerThread = 16384;  // one thread examines a subtree of at most this many nodes
        if (part.end - part.begin <= kMaxNodesPerThread) {
            parts_.push_back(part);
            return;
        }
        top_.push_back(part.node);
        const std::uint32_t left = bvh_.nodes[part.node].first;
        const BvhNode& right = bvh_.nodes[left + 1];
        const std::uint32_t middle = right.count > 0 ? part.end : right.first;
        collectParts({left, left + 2, middle});
        collectParts({left + 1, middle, part.end});
    }

    void examine(std::uint32_t index)
    {
        const BvhNode& node = bvh_.nodes[index];
        subtrees_[index] = node.count > 0 ? makeLeaf(node, bvh_.order[node.first] >= firstInstance_)
                                          : join(node, subtrees_[node.first], subtrees_[node.first + 1]);
    }

    const Bvh& bvh_;
    const unsigned threads_;
    const std::uint32_t firstInstance_;
    std::vector<Subtree> subtrees_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> top_;  // parents first
};

}  // namespace

std::vector<Subtree> examineSubtrees(const Bvh& bvh, unsigned threads, std::uint32_t firstInstance)
{
    return Examiner(bvh, threads, firstInstance).examine();
}

}  // namespace glim
