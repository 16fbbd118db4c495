#include "host/bvh/build_bvh.hpp"

#include "host/bvh/surface_area.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>
#include <optional>

namespace glim {
namespace {

constexpr std::uint32_t kMaxLeafSize = 2;
constexpr std::uint32_t kMaxBins = 32;

// Partitioned in place, so that a node's primitives lie together in memory.
struct Reference {
    Box box;
    std::uint32_t primitive;
};

struct Task {
    std::uint32_t node, begin, end;
    std::uint32_t depth;  // inner nodes above
};

// Never measured while empty: its area would be positive, and infinite.
Box makeEmptyBox() {
    constexpr float kMax = std::numeric_limits<float>::max();
    return {glm::vec3(kMax), glm::vec3(-kMax)};
}

void grow(Box& box, const Box& other) {
    box.lo = glm::min(box.lo, other.lo);
    box.hi = glm::max(box.hi, other.hi);
}

struct Bounds {
    Box box = makeEmptyBox();      // around the primitives
    Box centres = makeEmptyBox();  // around the centres of their boxes
};

Bounds computeBounds(std::span<const Reference> references) {
    Bounds bounds;
    for (const Reference& reference : references) {
        const glm::vec3 centre = computeCentre(reference.box);
        grow(bounds.box, reference.box);
        grow(bounds.centres, {centre, centre});
    }
    return bounds;
}

// Inner nodes on the longest path below a node of `count` primitives if all splits from here on are median splits.
std::uint32_t levelsOfMedianSplits(std::uint32_t count) {
    const auto levels = static_cast<std::uint32_t>(std::bit_width(count - 1));
    constexpr auto kLeafLevels = static_cast<std::uint32_t>(std::bit_width(kMaxLeafSize - 1));
    return levels > kLeafLevels ? levels - kLeafLevels : 0;
}

struct Bin {
    Box box = makeEmptyBox();
    std::uint32_t count = 0;

    void add(const Bin& other) {
        grow(box, other.box);
        count += other.count;
    }
    double computeWeight() const { return computeHalfArea(box) * count; }
};

// Equal slices of the box around the centres, on each axis.
class Slices {
public:
    Slices(const Box& centres, std::uint32_t slices)
        : count(slices), origin(centres.lo), perUnit(glm::dvec3(centres.hi) - glm::dvec3(centres.lo)) {
        for (int axis = 0; axis < 3; ++axis) {
            perUnit[axis] = perUnit[axis] > 0.0 ? count / perUnit[axis] : 0.0;
        }
    }

    std::uint32_t find(const glm::vec3& centre, int axis) const {
        const double slice = (static_cast<double>(centre[axis]) - origin[axis]) * perUnit[axis];
        return std::min(count - 1, static_cast<std::uint32_t>(slice));
    }

    const std::uint32_t count;

private:
    glm::dvec3 origin, perUnit;
};

// Slices below `slice` on `axis` go left.
struct Split {
    int axis;
    std::uint32_t slice;
    double weight;  // sum over both sides of half area * primitives
};

void chooseBetter(std::optional<Split>& best, const std::array<Bin, kMaxBins>& bins, int axis, std::uint32_t count) {
    std::array<double, kMaxBins> rightWeight{};
    Bin right;
    for (std::uint32_t i = count; --i > 0;) {
        right.add(bins[i]);
        rightWeight[i] = right.count > 0 ? right.computeWeight() : -1.0;
    }
    Bin left;
    for (std::uint32_t i = 1; i < count; ++i) {
        left.add(bins[i - 1]);
        if (left.count == 0 || rightWeight[i] < 0.0) {
            continue;
        }
        const double weight = left.computeWeight() + rightWeight[i];
        if (!best || weight < best->weight) {
            best = Split{axis, i, weight};
        }
    }
}

// Binned surface-area heuristic: I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007.
std::optional<Split> findSplit(std::span<const Reference> references, const Slices& slices) {
    std::array<std::array<Bin, kMaxBins>, 3> bins;
    for (const Reference& reference : references) {
        const glm::vec3 centre = computeCentre(reference.box);
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][slices.find(centre, axis)];
            grow(bin.box, reference.box);
            ++bin.count;
        }
    }
    std::optional<Split> best;
    for (int axis = 0; axis < 3; ++axis) {
        chooseBetter(best, bins[axis], axis, slices.count);
    }
    return best;
}

// On which the centres spread most.
int findWidestAxis(const Box& centres) {
    const glm::dvec3 extent = glm::dvec3(centres.hi) - glm::dvec3(centres.lo);
    return extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
}

// Equal centres by index, so the result is defined.
std::uint32_t partitionAtMedian(std::span<Reference> references, int axis) {
    const auto half = static_cast<std::uint32_t>(references.size() / 2);
    std::nth_element(references.begin(), references.begin() + half, references.end(),
                     [axis](const Reference& a, const Reference& b) {
                         const float ca = computeCentre(a.box)[axis], cb = computeCentre(b.box)[axis];
                         return ca < cb || (ca == cb && a.primitive < b.primitive);
                     });
    return half;
}

std::uint32_t partitionAtMean(std::span<Reference> references, int axis) {
    double sum = 0.0;
    for (const Reference& reference : references) {
        sum += static_cast<double>(computeCentre(reference.box)[axis]);
    }
    const double mean = sum / static_cast<double>(references.size());
    const auto middle = std::partition(references.begin(), references.end(), [&](const Reference& reference) {
        return static_cast<double>(computeCentre(reference.box)[axis]) < mean;
    });
    return static_cast<std::uint32_t>(middle - references.begin());
}

std::uint32_t partition(std::span<Reference> references, const Slices& slices, const Split& split) {
    const auto middle = std::partition(references.begin(), references.end(), [&](const Reference& reference) {
        return slices.find(computeCentre(reference.box), split.axis) < split.slice;
    });
    return static_cast<std::uint32_t>(middle - references.begin());
}

// Whether both sides of a split have primitives, and the larger one finds room in the depth that is left.
bool isAdmissible(std::uint32_t left, std::uint32_t count, std::uint32_t depth) {
    return left > 0 && left < count && depth + 1 + levelsOfMedianSplits(std::max(left, count - left)) <= kMaxBvhDepth;
}

// Reorders the references and returns how many go left; 0 if a leaf is better.
std::uint32_t divideBySah(std::span<Reference> references, const Bounds& bounds, std::uint32_t depth) {
    const auto count = static_cast<std::uint32_t>(references.size());
    if (count == 1) {
        return 0;
    }
    const double area = computeHalfArea(bounds.box);
    const Slices slices(bounds.centres, std::clamp(count, 4U, kMaxBins));
    const std::optional<Split> split = area > 0.0 ? findSplit(references, slices) : std::nullopt;
    // In units of one primitive test; a step through an inner node costs about the same (it reads 4 texels to a
    // triangle's 3).
    const bool splitPays = split && area + split->weight < area * count;
    if (count <= kMaxLeafSize && (!splitPays || depth == kMaxBvhDepth)) {
        return 0;
    }
    const std::uint32_t left = split ? partition(references, slices, *split) : 0;
    return isAdmissible(left, count, depth) ? left : partitionAtMedian(references, findWidestAxis(bounds.centres));
}

// As above, by a rule that does not ask what a leaf costs.
std::uint32_t divideAtMeanOrMedian(std::span<Reference> references, const Bounds& bounds, std::uint32_t depth, SplitRule rule) {
    const auto count = static_cast<std::uint32_t>(references.size());
    if (count <= kMaxLeafSize) {
        return 0;
    }
    const int axis = findWidestAxis(bounds.centres);
    const std::uint32_t left = rule == SplitRule::Mean ? partitionAtMean(references, axis) : 0;
    return isAdmissible(left, count, depth) ? left : partitionAtMedian(references, axis);
}

std::vector<Reference> makeReferences(std::span<const Box> boxes) {
    std::vector<Reference> references(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        references[i] = {boxes[i], i};
    }
    return references;
}

}  // namespace

Bvh buildBvh(std::span<const Box> boxes, SplitRule rule) {
    static_assert(kMaxBvhDepth >= 31, "2^32 primitives in leaves of 2 need 31 median splits");
    assert(!boxes.empty() && boxes.size() <= std::numeric_limits<std::uint32_t>::max() / 2);
    std::vector<Reference> references = makeReferences(boxes);
    Bvh bvh;
    bvh.nodes.reserve(boxes.size());
    bvh.nodes.emplace_back();
    std::vector<Task> tasks{{0, 0, static_cast<std::uint32_t>(boxes.size()), 0}};
    while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        const std::span<Reference> mine(references.begin() + task.begin, references.begin() + task.end);
        const Bounds bounds = computeBounds(mine);
        const std::uint32_t left = rule == SplitRule::Sah ? divideBySah(mine, bounds, task.depth)
                                                          : divideAtMeanOrMedian(mine, bounds, task.depth, rule);
        if (left == 0) {
            bvh.nodes[task.node] = {bounds.box, task.begin, task.end - task.begin};
            bvh.depth = std::max(bvh.depth, task.depth);
            continue;
        }
        const auto first = static_cast<std::uint32_t>(bvh.nodes.size());
        bvh.nodes[task.node] = {bounds.box, first, 0};
        bvh.nodes.resize(first + 2);
        tasks.push_back({first + 1, task.begin + left, task.end, task.depth + 1});
        tasks.push_back({first, task.begin, task.begin + left, task.depth + 1});
    }
    for (const Reference& reference : references) {
        bvh.order.push_back(reference.primitive);
    }
    bvh.cost = computeCost(bvh.nodes);
    return bvh;
}

}  // namespace glim
