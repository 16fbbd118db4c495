#include "tests/support/check_bvh.hpp"

#include "host/bvh/surface_area.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

std::string name(const char* what, std::size_t index) { return std::string(what) + " " + std::to_string(index); }

// False also for NaN.
bool contains(const Box& outer, const Box& inner)
{
    return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) && glm::all(glm::lessThanEqual(inner.hi, outer.hi));
}

class Checker {
public:
    Checker(const Bvh& bvh, std::span<const Box> boxes)
        : bvh_(bvh),
          boxes_(boxes),
          depths_(bvh.nodes.size(), kUnseen),
          covered_(bvh.order.size(), false),
          used_(boxes.size(), false)
    {}

    // Children lie after their parents, so one pass in order of index sees every parent first.
    std::optional<std::string> findDefect()
    {
        if (bvh_.nodes.empty() || bvh_.order.size() != boxes_.size()) {
            return "the tree has " + std::to_string(bvh_.nodes.size()) + " nodes and orders " + std::to_string(bvh_.order.size()) +
                   " primitives, expected " + std::to_string(boxes_.size());
        }
        depths_[0] = 0;
        for (std::size_t i = 0; i < bvh_.nodes.size(); ++i) {
            auto defect = depths_[i] == kUnseen      ? name("node", i) + " has no parent"
                          : bvh_.nodes[i].count == 0 ? findInnerDefect(i)
                                                     : findLeafDefect(i);
            if (defect) {
                return defect;
            }
        }
        // The checks above found as many leaf entries as primitives, and none twice, so only a gap can be left.
        for (std::size_t i = 0; i < covered_.size(); ++i) {
            if (!covered_[i]) {
                return name("entry", i) + " of the order is in no leaf";
            }
        }
        auto defect = findOrderDefect();
        return defect ? defect : findSummaryDefect();
    }

private:
    static constexpr std::uint32_t kUnseen = ~0U;

    std::optional<std::string> findInnerDefect(std::size_t index)
    {
        const BvhNode& node = bvh_.nodes[index];
        if (node.first <= index || node.first >= bvh_.nodes.size() - 1) {
            return name("node", index) + " has its children at " + std::to_string(node.first) + ", expected after " +
                   std::to_string(index) + " and before " + std::to_string(bvh_.nodes.size() - 1);
        }
        if (depths_[index] == kMaxBvhDepth) {
            return name("node", index) + " is inner node number " + std::to_string(kMaxBvhDepth + 1) +
                   " on its path, more than the traversal stack holds";
        }
        for (std::size_t child = node.first; child < std::size_t{node.first} + 2; ++child) {
            if (depths_[child] != kUnseen) {
                return name("node", child) + " has two parents, one of them " + name("node", index);
            }
            if (!contains(node.box, bvh_.nodes[child].box)) {
                return "the box of " + name("node", index) + " does not contain that of its child " + name("node", child);
            }
            depths_[child] = depths_[index] + 1;
        }
        return std::nullopt;
    }

    std::optional<std::string> findLeafDefect(std::size_t index)
    {
        const BvhNode& leaf = bvh_.nodes[index];
        if (std::size_t{leaf.first} + leaf.count > bvh_.order.size()) {
            return name("leaf", index) + " ends at " + std::to_string(std::size_t{leaf.first} + leaf.count) + ", beyond the " +
                   std::to_string(bvh_.order.size()) + " ordered primitives";
        }
        deepest_ = std::max(deepest_, depths_[index]);
        for (std::size_t i = leaf.first; i < std::size_t{leaf.first} + leaf.count; ++i) {
            const std::uint32_t primitive = bvh_.order[i];
            if (primitive >= boxes_.size()) {
                return name("leaf", index) + " holds primitive " + std::to_string(primitive) + " of only " + std::to_string(boxes_.size());
            }
            if (used_[primitive] || covered_[i]) {
                return name("primitive", primitive) + " is in " + name("leaf", index) + " and in a leaf before it";
            }
            used_[primitive] = covered_[i] = true;
            if (!contains(leaf.box, boxes_[primitive])) {
                return "the box of " + name("leaf", index) + " does not contain " + name("primitive", primitive);
            }
        }
        return std::nullopt;
    }

    // Expects a tree that has passed the other checks.
    std::optional<std::string> findOrderDefect() const
    {
        std::vector<std::size_t> stack{0};
        for (std::size_t next = 1; !stack.empty();) {
            const std::size_t index = stack.back();
            const BvhNode& node = bvh_.nodes[index];
            stack.pop_back();
            if (node.count > 0) {
                continue;
            }
            if (node.first != next) {
                return name("node", index) + " has its children at " + std::to_string(node.first) + ", depth first they are at " +
                       std::to_string(next);
            }
            stack.insert(stack.end(), {next + 1, next});
            next += 2;
        }
        return std::nullopt;
    }

    std::optional<std::string> findSummaryDefect() const
    {
        if (bvh_.depth != deepest_) {
            return "the tree's depth is " + std::to_string(deepest_) + ", but it says " + std::to_string(bvh_.depth);
        }
        const double cost = computeCost(bvh_.nodes);
        // Rounding of a sum of up to 2^32 terms stays far below this.
        if (!(std::abs(bvh_.cost - cost) <= 1e-6 * cost) || !std::isfinite(cost)) {
            return "the tree's cost is " + std::to_string(cost) + ", but it says " + std::to_string(bvh_.cost);
        }
        return std::nullopt;
    }

    const Bvh& bvh_;
    std::span<const Box> boxes_;
    std::vector<std::uint32_t> depths_;  // inner nodes above each node
    std::vector<bool> covered_, used_;   // entries of the order; primitives
    std::uint32_t deepest_ = 0;
};

}  // namespace

std::optional<std::string> findBvhDefect(const Bvh& bvh, std::span<const Box> boxes) { return Checker(bvh, boxes).findDefect(); }

}  // namespace glim
