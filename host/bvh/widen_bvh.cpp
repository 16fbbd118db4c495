// Which nodes stay: Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017,
// section 3.2: for each binary node and each i, the least cost of what is below as a forest of at most i roots.
#include "host/bvh/widen_bvh.hpp"

#include "host/bvh/surface_area.hpp"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <limits>

namespace glim {
namespace {

// Of a primitive's test (3 texels), where the visit of a node (5 texels, eight boxes) is 1. A guess by these counts, not yet a measurement.
constexpr float kPrimitiveCost = 0.5F;

constexpr std::uint32_t kMostRoots = kBvhWidth - 1;

// What is known of the part of a binary tree below a node.
struct Subtree {
    std::array<float, kMostRoots> cost;           // of a forest of at most i + 1 roots
    std::array<std::uint8_t, kMostRoots> toLeft;  // of these roots on the left side; 0: fewer roots are as good, or a leaf
    std::uint8_t nodeToLeft;                      // of a node's kBvhWidth children
    bool isLeaf;                                  // as a single root
    std::uint32_t first, count;                   // primitives
};

struct Division {
    float cost;
    std::uint8_t toLeft;
};

Division divide(const Subtree& left, const Subtree& right, std::uint32_t roots)
{
    Division best{std::numeric_limits<float>::infinity(), 1};
    for (std::uint32_t k = 1; k < roots; ++k) {
        const std::uint32_t l = std::min(k, kMostRoots), r = std::min(roots - k, kMostRoots);
        const float cost = left.cost[l - 1] + right.cost[r - 1];
        if (cost < best.cost) {
            best = {cost, static_cast<std::uint8_t>(k)};
        }
    }
    return best;
}

Subtree makeLeaf(const BvhNode& node)
{
    Subtree subtree{};
    subtree.cost.fill(static_cast<float>(computeHalfArea(node.box)) * static_cast<float>(node.count) * kPrimitiveCost);
    subtree.isLeaf = true;
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
    const float asLeaf = subtree.count <= kMaxLeafRecords ? area * static_cast<float>(subtree.count) * kPrimitiveCost
                                                       : std::numeric_limits<float>::infinity();
    const Division asNode = divide(left, right, kBvhWidth);
    subtree.nodeToLeft = asNode.toLeft;
    subtree.isLeaf = asLeaf <= asNode.cost + area;
    subtree.cost[0] = std::min(asLeaf, asNode.cost + area);
    for (std::uint32_t roots = 2; roots <= kMostRoots; ++roots) {
        const Division division = divide(left, right, roots);
        const bool pays = division.cost < subtree.cost[roots - 2];
        subtree.cost[roots - 1] = pays ? division.cost : subtree.cost[roots - 2];
        subtree.toLeft[roots - 1] = pays ? division.toLeft : 0;
    }
    return subtree;
}

// Children lie after their parents.
std::vector<Subtree> examine(const Bvh& bvh)
{
    std::vector<Subtree> subtrees(bvh.nodes.size());
    for (std::size_t i = bvh.nodes.size(); i-- > 0;) {
        const BvhNode& node = bvh.nodes[i];
        subtrees[i] = node.count > 0 ? makeLeaf(node) : join(node, subtrees[node.first], subtrees[node.first + 1]);
    }
    return subtrees;
}

using Roots = std::vector<std::uint32_t>;  // binary nodes

void collect(const Bvh& bvh, const std::vector<Subtree>& subtrees, std::uint32_t node, std::uint32_t most, Roots& roots)
{
    const Subtree& subtree = subtrees[node];
    while (most > 1 && subtree.toLeft[most - 1] == 0) {
        --most;
    }
    if (most == 1) {
        roots.push_back(node);
        return;
    }
    const std::uint32_t left = subtree.toLeft[most - 1];
    collect(bvh, subtrees, bvh.nodes[node].first, left, roots);
    collect(bvh, subtrees, bvh.nodes[node].first + 1, most - left, roots);
}

// The binary nodes that become the children of `node`.
Roots childrenOf(const Bvh& bvh, const std::vector<Subtree>& subtrees, std::uint32_t node)
{
    Roots roots;
    if (bvh.nodes[node].count > 0) {
        return {node};  // the root of so few primitives
    }
    const std::uint32_t left = subtrees[node].nodeToLeft;
    collect(bvh, subtrees, bvh.nodes[node].first, std::min(left, kMostRoots), roots);
    collect(bvh, subtrees, bvh.nodes[node].first + 1, std::min(kBvhWidth - left, kMostRoots), roots);
    return roots;
}

// places[i]: of roots[i]. The pair that gains most goes first; ties to the lower ones.
std::array<std::uint8_t, kBvhWidth> findPlaces(const Bvh& bvh, std::uint32_t node, const Roots& roots)
{
    const glm::vec3 middle = computeCentre(bvh.nodes[node].box);
    std::array<std::array<float, kBvhWidth>, kBvhWidth> gains{};  // of root i in place s
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const glm::vec3 from = computeCentre(bvh.nodes[roots[i]].box) - middle;
        for (std::uint32_t s = 0; s < kBvhWidth; ++s) {
            gains[i][s] = ((s & 1U) != 0 ? from.x : -from.x) + ((s & 2U) != 0 ? from.y : -from.y) + ((s & 4U) != 0 ? from.z : -from.z);
        }
    }
    std::array<std::uint8_t, kBvhWidth> places{};
    std::uint32_t placed = 0, taken = 0;
    for (std::size_t done = 0; done < roots.size(); ++done) {
        std::size_t root = kBvhWidth;
        std::uint32_t place = 0;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            for (std::uint32_t s = 0; s < kBvhWidth && (placed >> i & 1U) == 0; ++s) {
                if ((taken >> s & 1U) == 0 && (root == kBvhWidth || gains[i][s] > gains[root][place])) {
                    root = i;
                    place = s;
                }
            }
        }
        places[root] = static_cast<std::uint8_t>(place);
        placed |= 1U << root;
        taken |= 1U << place;
    }
    return places;
}

class Widener {
public:
    explicit Widener(const Bvh& bvh) : bvh_(bvh), subtrees_(examine(bvh)), rootArea_(computeHalfArea(bvh.nodes[0].box)) {}

    WideBvh widen()
    {
        wide_.box = bvh_.nodes[0].box;
        wide_.order.reserve(bvh_.order.size());
        wide_.nodes.emplace_back();
        tasks_ = {{0, 0, 1}};
        while (!tasks_.empty()) {
            const Task task = tasks_.back();
            tasks_.pop_back();
            addNode(task);
        }
        return std::move(wide_);
    }

private:
    struct Task {
        std::uint32_t binary, wide, depth;
    };

    double shareOf(const Box& box) const { return rootArea_ > 0.0 ? computeHalfArea(box) / rootArea_ : 1.0; }

    void addNode(const Task& task)
    {
        const Roots roots = childrenOf(bvh_, subtrees_, task.binary);
        const auto places = findPlaces(bvh_, task.binary, roots);
        WideNode node;
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const Subtree& subtree = subtrees_[roots[i]];
            node.children[places[i]] = {subtree.isLeaf ? WideChild::Kind::Leaf : WideChild::Kind::Inner, roots[i], subtree.count,
                                        bvh_.nodes[roots[i]].box};
        }
        wide_.depth = std::max(wide_.depth, task.depth);
        wide_.cost += shareOf(bvh_.nodes[task.binary].box);
        for (WideChild& child : node.children) {
            if (child.kind == WideChild::Kind::Inner) {
                tasks_.push_back({child.first, static_cast<std::uint32_t>(wide_.nodes.size()), task.depth + 1});
                child = {child.kind, static_cast<std::uint32_t>(wide_.nodes.size()), 0, child.box};
                wide_.nodes.emplace_back();
            } else if (child.kind == WideChild::Kind::Leaf) {
                wide_.cost += shareOf(child.box) * child.count;
                child.first = addLeaf(subtrees_[child.first]);
            }
        }
        wide_.nodes[task.wide] = node;
    }

    std::uint32_t addLeaf(const Subtree& leaf)
    {
        const auto first = static_cast<std::uint32_t>(wide_.order.size());
        const auto begin = bvh_.order.begin() + leaf.first;
        wide_.order.insert(wide_.order.end(), begin, begin + leaf.count);
        return first;
    }

    const Bvh& bvh_;
    const std::vector<Subtree> subtrees_;
    const double rootArea_;
    WideBvh wide_;
    std::vector<Task> tasks_;
};

}  // namespace

WideBvh widenBvh(const Bvh& bvh) { return Widener(bvh).widen(); }

}  // namespace glim
