#include "host/bvh/collapse_bvh.hpp"

#include "host/bvh/examine_subtrees.hpp"
#include "host/bvh/parallel_for.hpp"
#include "host/bvh/surface_area.hpp"

#include <algorithm>
#include <numeric>

namespace glim {
namespace {

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

// Collects the nodes that are `levels` below `node`, and the leaves above them.
void collectEvenly(const Bvh& bvh, std::uint32_t node, int levels, Roots& roots)
{
    if (levels == 0 || bvh.nodes[node].count > 0) {
        roots.push_back(node);
        return;
    }
    collectEvenly(bvh, bvh.nodes[node].first, levels - 1, roots);
    collectEvenly(bvh, bvh.nodes[node].first + 1, levels - 1, roots);
}

// Whether the subtree fits into the remaining depth if each wide node covers three levels of the binary tree.
bool fits(const Subtree& subtree, std::uint32_t depth) { return subtree.isLeaf || depth + (subtree.height + 2U) / 3 <= kMaxWideDepth; }

static_assert((kMaxBvhDepth + 2) / 3 <= kMaxWideDepth);

// The binary nodes that become the children of `node`, which is at `depth`: the cheapest ones, unless a subtree could become too deep.
Roots childrenOf(const Bvh& bvh, const std::vector<Subtree>& subtrees, std::uint32_t node, std::uint32_t depth)
{
    Roots roots;
    if (bvh.nodes[node].count > 0) {
        return {node};  // a leaf as root: few primitives
    }
    const std::uint32_t left = subtrees[node].nodeToLeft;
    collect(bvh, subtrees, bvh.nodes[node].first, std::min(left, kMaxRoots), roots);
    collect(bvh, subtrees, bvh.nodes[node].first + 1, std::min(kBvhWidth - left, kMaxRoots), roots);
    if (!std::all_of(roots.begin(), roots.end(), [&](std::uint32_t root) { return fits(subtrees[root], depth); })) {
        roots.clear();
        collectEvenly(bvh, node, 3, roots);
    }
    return roots;
}

// Returns the place of each root. Assigns greedily, the pair with the greatest gain first; ties go to the lower root, then the lower
// place.
std::array<std::uint8_t, kBvhWidth> findPlaces(const Bvh& bvh, std::uint32_t node, const Roots& roots)
{
    const glm::vec3 middle = computeCentre(bvh.nodes[node].box);
    std::array<std::array<float, kBvhWidth>, kBvhWidth> gains{};  // [root][place]
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

// A wide node still to be built: its binary node, and its index.
struct CollapseTask {
    std::uint32_t binary, wide, depth;
};

// Builds wide nodes from the top down, to subtrees of a given size.
class Collapser {
public:
    Collapser(const Bvh& bvh, const std::vector<Subtree>& subtrees, std::uint32_t firstInstance)
        : bvh_(bvh),
          subtrees_(subtrees),
          firstInstance_(firstInstance),
          rootArea_(computeHalfArea(bvh.nodes[0].box))
    {
        wide_.box = bvh.nodes[0].box;
    }

    // Returns the subtrees of at most `least` primitives, which are still to be built.
    std::vector<CollapseTask> collapse(std::uint32_t binary, std::uint32_t depth, std::uint32_t least)
    {
        std::vector<CollapseTask> left;
        wide_.nodes.reserve(subtrees_[binary].count / 6);  // meshes need about as many
        wide_.nodes.emplace_back();
        tasks_ = {{binary, 0, depth}};
        while (!tasks_.empty()) {
            const CollapseTask task = tasks_.back();
            tasks_.pop_back();
            if (subtrees_[task.binary].count > least) {
                addNode(task);
            } else {
                left.push_back(task);
            }
        }
        return left;
    }

    WideBvh& result() { return wide_; }

private:
    double shareOf(const Box& box) const { return rootArea_ > 0.0 ? computeHalfArea(box) / rootArea_ : 1.0; }

    void addNode(const CollapseTask& task)
    {
        const Roots roots = childrenOf(bvh_, subtrees_, task.binary, task.depth);
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
            } else if (child.kind == WideChild::Kind::Leaf && subtrees_[child.first].hasInstance) {
                child = addInstance(child, subtrees_[child.first].first);
                wide_.depth = std::max(wide_.depth, task.depth + 1);
            } else if (child.kind == WideChild::Kind::Leaf) {
                wide_.cost += shareOf(child.box) * child.count;
                child.first = addLeaf(subtrees_[child.first]);
            }
        }
        wide_.nodes[task.wide] = node;
    }

    WideChild addInstance(const WideChild& leaf, std::uint32_t entry)
    {
        const auto node = static_cast<std::uint32_t>(wide_.nodes.size());
        wide_.instances.push_back({node, bvh_.order[entry] - firstInstance_, 0});
        wide_.nodes.emplace_back();
        return {WideChild::Kind::Inner, node, 0, leaf.box};
    }

    std::uint32_t addLeaf(const Subtree& leaf)
    {
        const auto first = static_cast<std::uint32_t>(wide_.order.size());
        const auto begin = bvh_.order.begin() + leaf.first;
        wide_.order.insert(wide_.order.end(), begin, begin + leaf.count);
        return first;
    }

    const Bvh& bvh_;
    const std::vector<Subtree>& subtrees_;
    const std::uint32_t firstInstance_;
    const double rootArea_;
    WideBvh wide_;
    std::vector<CollapseTask> tasks_;
};

// The first node of `part` becomes node `at` of the tree.
void append(WideBvh& wide, const WideBvh& part, std::uint32_t at)
{
    const auto firstNode = static_cast<std::uint32_t>(wide.nodes.size()) - 1;
    const auto firstEntry = static_cast<std::uint32_t>(wide.order.size());
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
        WideNode& node = i == 0 ? wide.nodes[at] : wide.nodes.emplace_back();
        node = part.nodes[i];
        for (WideChild& child : node.children) {
            child.first += child.kind == WideChild::Kind::Inner ? firstNode : child.kind == WideChild::Kind::Leaf ? firstEntry : 0;
        }
    }
    for (const InstanceNode& instance : part.instances) {
        wide.instances.push_back({instance.node + firstNode, instance.instance, 0});
    }
    wide.order.insert(wide.order.end(), part.order.begin(), part.order.end());
    wide.depth = std::max(wide.depth, part.depth);
    wide.cost += part.cost;
}

}  // namespace

WideBvh collapseBvh(const Bvh& bvh, unsigned threads, std::uint32_t firstInstance)
{
    constexpr std::uint32_t kMaxPrimitivesPerThread = 8192;  // one thread builds a subtree of at most this many primitives
    const std::vector<Subtree> subtrees = examineSubtrees(bvh, threads, firstInstance);
    Collapser top(bvh, subtrees, firstInstance);
    const std::vector<CollapseTask> tasks = top.collapse(0, 1, kMaxPrimitivesPerThread);
    std::vector<Collapser> parts(tasks.size(), Collapser(bvh, subtrees, firstInstance));
    parallelFor(tasks.size(), threads, [&](std::size_t i) { parts[i].collapse(tasks[i].binary, tasks[i].depth, 0); });
    WideBvh wide = std::move(top.result());
    wide.order.reserve(bvh.order.size());
    wide.nodes.reserve(std::accumulate(parts.begin(), parts.end(), wide.nodes.size(),
                                       [](std::size_t sum, Collapser& part) { return sum + part.result().nodes.size(); }));
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        append(wide, parts[i].result(), tasks[i].wide);
    }
    return wide;
}

}  // namespace glim
