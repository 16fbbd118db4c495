#include "host/bvh/split_node.hpp"

#include <bit>

namespace glim {
namespace {

// Inner nodes on the longest path below a node of `count` primitives if all splits from here on are median splits.
std::uint32_t levelsOfMedianSplits(std::uint32_t count, std::uint32_t leafSize)
{
    static_assert(kMaxBvhDepth >= 32, "2^32 primitives in leaves of 1 need 32 median splits");
    const auto levels = static_cast<std::uint32_t>(std::bit_width(count - 1));
    const auto leafLevels = static_cast<std::uint32_t>(std::bit_width(leafSize - 1));
    return levels > leafLevels ? levels - leafLevels : 0;
}

// Whether both sides of a split have primitives, and the larger side fits into the remaining depth.
bool isAdmissible(std::uint32_t left, std::uint32_t count, std::uint32_t depth, std::uint32_t leafSize)
{
    return left > 0 && left < count && depth + 1 + levelsOfMedianSplits(std::max(left, count - left), leafSize) <= kMaxBvhDepth;
}

// The axis on which the centres spread most.
std::size_t findWidestAxis(const LaneBox& centres)
{
    const Lanes extent = centres.computeHalfExtent();
    return extent.v[0] >= extent.v[1] ? (extent.v[0] >= extent.v[2] ? 0 : 2) : (extent.v[1] >= extent.v[2] ? 1 : 2);
}

NodeSplit measure(std::span<const Reference> references, std::uint32_t left)
{
    return {left, {computeBounds(references.first(left)), computeBounds(references.subspan(left))}};
}

// Ties are broken by index, so that the result is deterministic.
NodeSplit splitAtMedian(std::span<Reference> references)
{
    const std::size_t axis = findWidestAxis(computeBounds(references).centres);
    const auto half = static_cast<std::uint32_t>(references.size() / 2);
    std::nth_element(references.begin(), references.begin() + half, references.end(), [axis](const Reference& a, const Reference& b) {
        const float ca = a.computeCentre().v[axis], cb = b.computeCentre().v[axis];
        return ca < cb || (ca == cb && a.primitive() < b.primitive());
    });
    return measure(references, half);
}

NodeSplit splitAtMean(std::span<Reference> references, const NodeBounds& bounds)
{
    const std::size_t axis = findWidestAxis(bounds.centres);
    double sum = 0.0;
    for (const Reference& reference : references) {
        sum += static_cast<double>(reference.computeCentre().v[axis]);
    }
    const double mean = sum / static_cast<double>(references.size());
    const auto middle = std::partition(references.begin(), references.end(), [&](const Reference& reference) {
        return static_cast<double>(reference.computeCentre().v[axis]) < mean;
    });
    return measure(references, static_cast<std::uint32_t>(middle - references.begin()));
}

}  // namespace

NodeSplit splitNode(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds, std::uint32_t depth,
                    SplitRule rule, std::uint32_t leafSize)
{
    const auto count = static_cast<std::uint32_t>(references.size());
    if (count == 1 || (count <= leafSize && (rule != SplitRule::Sah || depth == kMaxBvhDepth))) {
        return {};
    }
    NodeSplit split;
    if (rule == SplitRule::Sah) {
        split = splitBySah(references, scratch, bounds);
    } else if (rule == SplitRule::Mean) {
        split = splitAtMean(references, bounds);
    }
    if (split.left == 0 && count <= leafSize) {
        return {};
    }
    return isAdmissible(split.left, count, depth, leafSize) ? split : splitAtMedian(references);
}

}  // namespace glim
