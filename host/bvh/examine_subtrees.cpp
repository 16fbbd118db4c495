#include "host/bvh/examine_subtrees.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/bvh/surface_area.hpp"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <array>
#include <limits>

namespace glim {
namespace {

// The cost of a primitive test (3 texels) relative to a node visit (5 texels, eight boxes). A guess from these counts, not yet measured.
constexpr float kPrimitiveCost = 0.5F;

constexpr std::uint32_t kCountMask = 0x7FFFFFFFU;  // what Subtree::count holds

// [i]: the least surface-area cost of a subtree as a forest of at most i + 1 roots.
using Costs = std::array<float, kMaxRoots>;

// The cheapest way to share out the roots, and how many of them are then below the left child.
struct RootShare {
    float cost;
    std::uint32_t toLeft;
};

RootShare shareRoots(const Costs& left, const Costs& right, std::uint32_t roots)
{
    RootShare best{std::numeric_limits<float>::infinity(), 1};
    for (std::uint32_t k = 1; k < roots; ++k) {
        const std::uint32_t l = std::min(k, kMaxRoots), r = std::min(roots - k, kMaxRoots);
        const float cost = left[l - 1] + right[r - 1];
        if (cost < best.cost) {
            best = {cost, k};
        }
    }
    return best;
}

// A subtree: its root `node`, and nodes [begin, end) below it, which are contiguous because bvh.hpp demands depth-first order.
struct Part {
    std::uint32_t node, begin, end;
    Costs costs{};
};

class Examiner {
public:
    Examiner(const Bvh& bvh, unsigned threads, const Entries& entries)
        : bvh_(bvh),
          threads_(threads),
          entries_(entries),
          subtrees_(bvh.nodes.size())
    {}

    std::vector<Subtree> examine()
    {
        collectParts({0, 1, static_cast<std::uint32_t>(bvh_.nodes.size())});
        parallelFor(parts_.size(), threads_, [&](std::size_t i) { parts_[i].costs = examine(parts_[i].node); });
        examineTop(0);
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
        const std::uint32_t left = bvh_.nodes[part.node].first;
        const BvhNode& right = bvh_.nodes[left + 1];
        const std::uint32_t middle = right.count > 0 ? part.end : right.first;
        collectParts({left, left + 2, middle});
        collectParts({left + 1, middle, part.end});
    }

    // Meets the parts in the order in which they were collected.
    Costs examineTop(std::uint32_t index)
    {
        if (parts_[nextPart_].node == index) {
            return parts_[nextPart_++].costs;
        }
        const std::uint32_t first = bvh_.nodes[index].first;
        const Costs left = examineTop(first), right = examineTop(first + 1);
        return join(index, left, right);
    }

    Costs examine(std::uint32_t index)
    {
        const BvhNode& node = bvh_.nodes[index];
        if (node.count > 0) {
            return makeLeaf(index);
        }
        const Costs left = examine(node.first), right = examine(node.first + 1);
        return join(index, left, right);
    }

    Costs makeLeaf(std::uint32_t index)
    {
        const BvhNode& node = bvh_.nodes[index];
        const std::uint32_t entry = bvh_.order[node.first];
        const bool isTree = entries_.isTree(entry);
        Subtree& subtree = subtrees_[index];
        subtree.isLeaf = 1;
        subtree.height = isTree ? 3 * kMaxDepthOfEntry : 0;
        subtree.isAlone = isTree || entries_.isInstance(entry) ? 1 : 0;
        subtree.count = node.count & kCountMask;
        Costs costs;  // of a tree the same whatever is chosen, and therefore left out
        costs.fill(isTree ? 0.0F : static_cast<float>(computeHalfArea(node.box)) * static_cast<float>(node.count) * kPrimitiveCost);
        return costs;
    }

    Costs join(std::uint32_t index, const Costs& left, const Costs& right)
    {
        const BvhNode& node = bvh_.nodes[index];
        const Subtree &leftTree = subtrees_[node.first], &rightTree = subtrees_[node.first + 1];
        Subtree& subtree = subtrees_[index];
        subtree.count = (leftTree.count + rightTree.count) & kCountMask;
        const auto area = static_cast<float>(computeHalfArea(node.box));
        subtree.isAlone = leftTree.isAlone | rightTree.isAlone;
        const float asLeaf = subtree.count <= kMaxLeafRefs && subtree.isAlone == 0
                                 ? area * static_cast<float>(subtree.count) * kPrimitiveCost
                                 : std::numeric_limits<float>::infinity();
        subtree.height = (1U + std::max<std::uint32_t>(leftTree.height, rightTree.height)) & 127U;
        const RootShare asNode = shareRoots(left, right, kBvhWidth);
        subtree.nodeToLeft = asNode.toLeft & 7U;
        subtree.isLeaf = asLeaf <= asNode.cost + area ? 1 : 0;
        std::uint32_t toLeft = 0;
        Costs costs;
        costs[0] = std::min(asLeaf, asNode.cost + area);
        for (std::uint32_t roots = 2; roots <= kMaxRoots; ++roots) {
            const RootShare share = shareRoots(left, right, roots);
            const bool pays = share.cost < costs[roots - 2];
            costs[roots - 1] = pays ? share.cost : costs[roots - 2];
            toLeft |= pays ? share.toLeft << 3 * (roots - 1) : 0U;
        }
        subtree.toLeft = toLeft & ((1U << 3 * kMaxRoots) - 1);
        return costs;
    }

    const Bvh& bvh_;
    const unsigned threads_;
    const Entries& entries_;
    std::vector<Subtree> subtrees_;
    std::vector<Part> parts_;
    std::size_t nextPart_ = 0;
};

}  // namespace

std::vector<Subtree> examineSubtrees(const Bvh& bvh, unsigned threads, const Entries& entries)
{
    return Examiner(bvh, threads, entries).examine();
}

}  // namespace glim
