#include "host/bvh/build_bvh.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/bvh/split_node.hpp"
#include "host/bvh/surface_area.hpp"

#include <cassert>
#include <memory>
#include <numeric>
#include <vector>

namespace glim {
namespace {

// The largest subtree that one thread builds alone, in primitives: it fits the cache of a core.
constexpr std::uint32_t kMaxPerThread = 8192;

struct BuildTask {
    std::uint32_t node, begin, end;
    std::uint32_t depth;  // inner nodes above
    NodeBounds bounds;
};

// A node near the root. If it has few primitives, its whole subtree is one part.
struct BuildPart {
    BuildTask task;
    std::uint32_t children = 0;  // index of the first of two child parts; 0: `nodes` holds the whole subtree
    std::vector<BvhNode> nodes;
    std::uint32_t depth = 0;  // of the deepest leaf
};

class Builder {
public:
    Builder(std::vector<Box> boxes, SplitRule rule, unsigned threads, std::uint32_t leafSize, std::uint32_t maxPerThread = kMaxPerThread)
        : count_(static_cast<std::uint32_t>(boxes.size())),
          rule_(rule),
          threads_(threads),
          leafSize_(leafSize),
          maxPerThread_(maxPerThread),
          references_(std::make_unique_for_overwrite<Reference[]>(count_)),
          scratch_(std::make_unique_for_overwrite<Reference[]>(count_))
    {
        parts_.push_back({{0, 0, count_, 0, readBoxes(std::move(boxes))}, 0, {}, 0});
    }

    Bvh build()
    {
        splitTop();
        return finish([&](BuildPart& part) { buildBelow(part); });
    }

    Bvh divide()
    {
        splitTop();
        return finish([](BuildPart& part) {
            const BuildTask& task = part.task;
            part.nodes = {{task.bounds.box.box(), task.begin, task.end - task.begin}};
            part.depth = task.depth;
        });
    }

private:
    template <class Fill>
    Bvh finish(const Fill& fill)
    {
        parallelFor(parts_.size(), threads_, [&](std::size_t i) {
            if (parts_[i].children == 0) {
                fill(parts_[i]);
            }
        });
        scratch_.reset();
        Bvh bvh;
        bvh.order.resize(count_);
        for (std::uint32_t i = 0; i < count_; ++i) {
            bvh.order[i] = references_[i].primitive();
        }
        references_.reset();
        join(bvh);
        bvh.cost = computeCost(bvh.nodes);
        return bvh;
    }

    NodeBounds readBoxes(const std::vector<Box> boxes)
    {
        std::vector<NodeBounds> bounds((count_ + kMaxPerThread - 1) / kMaxPerThread);
        parallelFor(bounds.size(), threads_, [&](std::size_t chunk) {
            const auto begin = static_cast<std::uint32_t>(chunk) * kMaxPerThread, end = std::min(begin + kMaxPerThread, count_);
            for (std::uint32_t i = begin; i < end; ++i) {
                references_[i] = {boxes[i], i};
            }
            bounds[chunk] = computeBounds({&references_[begin], end - begin});
        });
        for (const NodeBounds& chunk : bounds) {
            bounds.front().grow(chunk);
        }
        return bounds.front();
    }

    NodeSplit split(const BuildTask& task)
    {
        const std::size_t count = task.end - task.begin;
        return splitNode({&references_[task.begin], count}, {&scratch_[task.begin], count}, task.bounds, task.depth, rule_, leafSize_);
    }

    // Splits level by level.
    void splitTop()
    {
        for (std::size_t begin = 0, end = 1; begin < end; begin = end, end = parts_.size()) {
            std::vector<NodeSplit> splits(end - begin);
            parallelFor(splits.size(), threads_, [&](std::size_t i) {
                const BuildTask& task = parts_[begin + i].task;
                splits[i] = task.end - task.begin > maxPerThread_ ? split(task) : NodeSplit{};
            });
            for (std::size_t i = begin; i < end; ++i) {
                const BuildTask task = parts_[i].task;
                const auto& [left, sides] = splits[i - begin];
                if (left > 0) {
                    parts_[i].children = static_cast<std::uint32_t>(parts_.size());
                    parts_.push_back({{0, task.begin, task.begin + left, task.depth + 1, sides[0]}, 0, {}, 0});
                    parts_.push_back({{0, task.begin + left, task.end, task.depth + 1, sides[1]}, 0, {}, 0});
                }
            }
        }
    }

    void buildBelow(BuildPart& part)
    {
        std::vector<BvhNode>& nodes = part.nodes;
        nodes.reserve(2 * (part.task.end - part.task.begin));
        nodes.emplace_back();
        std::vector<BuildTask> tasks{part.task};
        while (!tasks.empty()) {
            const BuildTask task = tasks.back();
            tasks.pop_back();
            const auto& [left, sides] = split(task);
            if (left == 0) {
                nodes[task.node] = {task.bounds.box.box(), task.begin, task.end - task.begin};
                part.depth = std::max(part.depth, task.depth);
                continue;
            }
            const auto first = static_cast<std::uint32_t>(nodes.size());
            nodes[task.node] = {task.bounds.box.box(), first, 0};
            nodes.resize(first + 2);
            tasks.push_back({first + 1, task.begin + left, task.end, task.depth + 1, sides[1]});
            tasks.push_back({first, task.begin, task.begin + left, task.depth + 1, sides[0]});
        }
    }

    // Joins all parts in depth-first order, and frees each.
    void join(Bvh& bvh)
    {
        bvh.nodes.reserve(std::accumulate(parts_.begin(), parts_.end(), std::size_t{2},
                                          [](std::size_t sum, const BuildPart& part) { return sum + part.nodes.size() + 1; }));
        bvh.nodes.emplace_back();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> places{{0, 0}};  // part, node
        while (!places.empty()) {
            const auto [index, node] = places.back();
            places.pop_back();
            BuildPart& part = parts_[index];
            const auto first = static_cast<std::uint32_t>(bvh.nodes.size());
            if (part.children != 0) {
                bvh.nodes[node] = {part.task.bounds.box.box(), first, 0};
                bvh.nodes.resize(first + 2);
                places.push_back({part.children + 1, first + 1});
                places.push_back({part.children, first});
                continue;
            }
            // The part's node 0 becomes `node`; its node i > 0 becomes first - 1 + i.
            for (std::size_t i = 0; i < part.nodes.size(); ++i) {
                BvhNode copy = part.nodes[i];
                copy.first += copy.count == 0 ? first - 1 : 0;
                if (i == 0) {
                    bvh.nodes[node] = copy;
                } else {
                    bvh.nodes.push_back(copy);
                }
            }
            bvh.depth = std::max(bvh.depth, part.depth);
            part.nodes = std::vector<BvhNode>();  // {} would keep the memory
        }
    }

    const std::uint32_t count_;
    const SplitRule rule_;
    const unsigned threads_;
    const std::uint32_t leafSize_, maxPerThread_;
    std::unique_ptr<Reference[]> references_, scratch_;
    std::vector<BuildPart> parts_;
};

}  // namespace

Bvh buildBvh(std::vector<Box> boxes, SplitRule rule, unsigned threads, std::uint32_t leafSize)
{
    assert(!boxes.empty() && boxes.size() <= std::numeric_limits<std::uint32_t>::max() / 2);
    return Builder(std::move(boxes), rule, threads, leafSize).build();
}

Bvh divide(std::vector<Box> boxes, SplitRule rule, unsigned threads, std::uint32_t most)
{
    assert(!boxes.empty() && boxes.size() <= std::numeric_limits<std::uint32_t>::max() / 2);
    return Builder(std::move(boxes), rule, threads, 1, most).divide();
}

}  // namespace glim
