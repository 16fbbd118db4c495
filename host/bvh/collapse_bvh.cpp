#include "host/bvh/collapse_bvh.hpp"

#include "host/bvh/examine_subtrees.hpp"
#include "host/bvh/parallel_for.hpp"
#include "host/bvh/surface_area.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

namespace glim {
namespace {

using Roots = std::vector<std::uint32_t>;  // binary nodes

void collect(const Bvh& bvh, const std::vector<Subtree>& subtrees, std::uint32_t node, std::uint32_t most, Roots& roots)
{
    const Subtree& subtree = subtrees[node];
    while (most > 1 && subtree.getToLeft(most) == 0) {
        --most;
    }
    if (most == 1) {
        roots.push_back(node);
        return;
    }
    const std::uint32_t left = subtree.getToLeft(most);
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
bool fits(const Subtree& subtree, std::uint32_t depth)
{
    return (subtree.isLeaf != 0 && subtree.isAlone == 0) || depth + (subtree.height + 2U) / 3 <= kMaxWideDepth;
}

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

// Returns the place of each child. Assigns greedily, the pair with the greatest gain first; ties go to the lower child, then the lower
// place.
std::array<std::uint8_t, kBvhWidth> findPlaces(const Box& node, std::span<const WideChild> roots)
{
    const glm::vec3 middle = computeCentre(node);
    std::array<std::array<float, kBvhWidth>, kBvhWidth> gains{};  // [child][place]
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const glm::vec3 from = computeCentre(roots[i].box) - middle;
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

// A node that becomes the root of an entry's tree.
struct TreeNode {
    std::uint32_t node, tree, depth;
    double share;  // of the whole tree's area
};

// A part of the wide tree.
struct WidePart {
    WideBvh wide;
    std::vector<TreeNode> trees;
};

// Builds wide nodes from the top down, to subtrees of a given size.
class Collapser {
public:
    Collapser(const Bvh& bvh, const std::vector<Subtree>& subtrees, const Entries& entries)
        : bvh_(bvh),
          subtrees_(subtrees),
          entries_(entries),
          rootArea_(computeHalfArea(bvh.nodes[0].box))
    {
        wide_.box = bvh.nodes[0].box;
    }

    // Returns the subtrees of at most `least` entries, which are still to be built.
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

    WidePart take() { return {std::move(wide_), std::move(trees_)}; }

private:
    double shareOf(const Box& box) const { return rootArea_ > 0.0 ? computeHalfArea(box) / rootArea_ : 1.0; }

    void addNode(const CollapseTask& task)
    {
        std::vector<WideChild> children;
        for (const std::uint32_t root : childrenOf(bvh_, subtrees_, task.binary, task.depth)) {
            const Subtree& subtree = subtrees_[root];
            children.push_back(
                {subtree.isLeaf != 0 ? WideChild::Kind::Leaf : WideChild::Kind::Inner, root, subtree.count, bvh_.nodes[root].box});
        }
        const auto places = findPlaces(bvh_.nodes[task.binary].box, children);
        WideNode node;
        for (std::size_t i = 0; i < children.size(); ++i) {
            node.children[places[i]] = children[i];
        }
        wide_.depth = std::max(wide_.depth, task.depth);
        wide_.cost += shareOf(bvh_.nodes[task.binary].box);
        for (WideChild& child : node.children) {
            if (child.kind == WideChild::Kind::Inner) {
                tasks_.push_back({child.first, addNodeFor(child), task.depth + 1});
            } else if (child.kind == WideChild::Kind::Leaf) {
                addLeaf(child, task.depth);
            }
        }
        wide_.nodes[task.wide] = node;
    }

    // The child becomes an inner one.
    std::uint32_t addNodeFor(WideChild& child)
    {
        const auto node = static_cast<std::uint32_t>(wide_.nodes.size());
        wide_.nodes.emplace_back();
        child = {WideChild::Kind::Inner, node, 0, child.box};
        return node;
    }

    // `leaf` has the index of its binary node, and the number of entries below that.
    void addLeaf(WideChild& leaf, std::uint32_t depth)
    {
        const auto below = std::span(bvh_.order).subspan(findFirstEntry(leaf.first), leaf.count);
        if (entries_.isTree(below[0])) {
            trees_.push_back({addNodeFor(leaf), below[0] - entries_.firstTree, depth + 1, shareOf(leaf.box)});
        } else if (entries_.isInstance(below[0])) {
            wide_.instances.push_back({addNodeFor(leaf), below[0] - entries_.firstInstance, 0});
            wide_.depth = std::max(wide_.depth, depth + 1);
        } else {
            wide_.cost += shareOf(leaf.box) * leaf.count;
            leaf.first = static_cast<std::uint32_t>(wide_.order.size());
            std::ranges::transform(below, std::back_inserter(wide_.order), [&](std::uint32_t entry) { return entries_.getSingle(entry); });
        }
    }

    std::uint32_t findFirstEntry(std::uint32_t node) const
    {
        while (bvh_.nodes[node].count == 0) {
            node = bvh_.nodes[node].first;
        }
        return bvh_.nodes[node].first;
    }

    const Bvh& bvh_;
    const std::vector<Subtree>& subtrees_;
    const Entries& entries_;
    const double rootArea_;
    WideBvh wide_;
    std::vector<TreeNode> trees_;
    std::vector<CollapseTask> tasks_;
};

// The first node of `part` becomes node `at` of the tree. Depth and cost are the caller's.
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
}

}  // namespace

WideBvh collapseBvh(Bvh bvh, const Entries& entries, unsigned threads)
{
    constexpr std::uint32_t kMaxEntriesPerThread = 8192;  // one thread builds a subtree of at most this many entries
    std::vector<Subtree> subtrees = examineSubtrees(bvh, threads, entries);
    Collapser top(bvh, subtrees, entries);
    const std::vector<CollapseTask> tasks = top.collapse(0, 1, kMaxEntriesPerThread);
    std::vector<WidePart> parts(tasks.size());
    parallelFor(tasks.size(), threads, [&](std::size_t i) {
        Collapser part(bvh, subtrees, entries);
        part.collapse(tasks[i].binary, tasks[i].depth, 0);
        parts[i] = part.take();
    });
    auto [wide, treeNodes] = top.take();
    wide.order.reserve(bvh.order.size() + entries.inTrees);
    bvh = {};
    subtrees = std::vector<Subtree>();
    constexpr std::size_t kLeastInNode = 5;  // trees of points have seven primitives a node
    wide.nodes.reserve(std::accumulate(parts.begin(), parts.end(), wide.nodes.size() + entries.inTrees / kLeastInNode,
                                       [](std::size_t sum, const WidePart& part) { return sum + part.wide.nodes.size(); }));
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const auto [part, trees] = std::exchange(parts[i], {});
        for (const TreeNode& tree : trees) {
            const std::uint32_t first = static_cast<std::uint32_t>(wide.nodes.size()) - 1;
            treeNodes.push_back({tree.node + first, tree.tree, tree.depth, tree.share});
        }
        append(wide, part, tasks[i].wide);
        wide.depth = std::max(wide.depth, part.depth);
        wide.cost += part.cost;
    }
    for (const TreeNode& node : treeNodes) {
        const WideBvh tree = entries.makeTree(node.tree);
        append(wide, tree, node.node);
        wide.depth = std::max(wide.depth, node.depth + tree.depth - 1);
        wide.cost += node.share * tree.cost;
    }
    return wide;
}

}  // namespace glim
