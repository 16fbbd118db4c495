#include "host/bvh/split_node.hpp"

#include <cstdint>

namespace glim {
namespace {

constexpr std::uint32_t kMaxSwept = 4;
constexpr std::uint32_t kMaxBins = 32;
constexpr double kNever = std::numeric_limits<double>::infinity();

// --- Few primitives: every split between two centres ---

using Order = std::array<std::uint32_t, kMaxSwept>;

// A stable sort by centre. Ranking by counting has no branch that could be mispredicted.
Order sortAlong(std::size_t axis, std::span<const Lanes> centres)
{
    Order order{};
    for (std::uint32_t i = 0; i < centres.size(); ++i) {
        std::uint32_t before = 0;
        for (std::uint32_t j = 0; j < centres.size(); ++j) {
            before += centres[j].v[axis] < centres[i].v[axis] || (centres[j].v[axis] == centres[i].v[axis] && j < i) ? 1 : 0;
        }
        order[before] = i;
    }
    return order;
}

struct Place {
    double weight = kNever;  // sum over both sides of area * primitives
    std::uint32_t left = 0;
    Order order{};
};

void chooseBetter(Place& best, std::span<const Reference> references, const Order& order)
{
    const auto count = static_cast<std::uint32_t>(references.size());
    std::array<double, kMaxSwept> rightWeight;
    LaneBox right;
    for (std::uint32_t i = count; --i > 0;) {
        right.grow(references[order[i]].box);
        rightWeight[i] = right.computeArea() * (count - i);
    }
    LaneBox left;
    for (std::uint32_t i = 1; i < count; ++i) {
        left.grow(references[order[i - 1]].box);
        const double weight = left.computeArea() * i + rightWeight[i];
        if (weight < best.weight) {
            best = {weight, i, order};
        }
    }
}

NodeSplit splitBySweep(std::span<Reference> references, double area)
{
    std::array<Reference, kMaxSwept> before;
    std::array<Lanes, kMaxSwept> centres;
    const std::size_t count = references.size();
    for (std::size_t i = 0; i < count; ++i) {
        before[i] = references[i];
        centres[i] = references[i].computeCentre();
    }
    Place best;
    for (std::size_t axis = 0; axis < (count == 2 ? 1 : 3); ++axis) {
        chooseBetter(best, references, sortAlong(axis, std::span(centres).first(count)));
    }
    // In units of one primitive test. Visiting an inner node costs about the same (it reads 5 texels, a triangle 3).
    if (count == 2 && area + best.weight >= 2.0 * area) {
        return {};
    }
    for (std::size_t i = 0; i < count; ++i) {
        references[i] = before[best.order[i]];
    }
    return {best.left, {computeBounds(references.first(best.left)), computeBounds(references.subspan(best.left))}};
}

// --- Many primitives: I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007 ---

// The slice of each reference on each axis, in blocks, so that compilers turn the short loops into vector instructions.
constexpr std::size_t kBlock = 64;
using Block = std::array<std::array<std::int32_t, 4>, kBlock>;

// Cuts the box around the centres into equal slices on each axis.
class Slices {
public:
    Slices(const LaneBox& centres, std::uint32_t slices)
        : origin_(centres.lo),
          count_(static_cast<float>(slices)),
          last_(static_cast<std::int32_t>(slices) - 1)
    {
        for (std::size_t k = 0; k < 4; ++k) {
            const float extent = 0.5F * centres.hi.v[k] - 0.5F * centres.lo.v[k];
            extent_.v[k] = extent > 0.0F ? extent : 1.0F;
        }
    }

    // Divides, because the reciprocal of a length may be too large or too small for a float.
    std::int32_t find(const Lanes& centre, std::size_t axis) const
    {
        const float share = (0.5F * centre.v[axis] - 0.5F * origin_.v[axis]) / extent_.v[axis];
        return std::min(static_cast<std::int32_t>(share * count_), last_);
    }

    // Slices of at most kBlock references, on all axes.
    Block find(std::span<const Reference> references) const
    {
        Block block;
        for (std::size_t i = 0; i < references.size(); ++i) {
            const Lanes centre = references[i].computeCentre();
            for (std::size_t k = 0; k < 4; ++k) {
                block[i][k] = find(centre, k);
            }
        }
        return block;
    }

private:
    Lanes origin_, extent_{};
    float count_;
    std::int32_t last_;
};

// The bins of one axis.
struct Bins {
    std::array<LaneBox, kMaxBins> boxes;
    std::array<std::uint32_t, kMaxBins> counts{};
};

// Slices below `slice` on `axis` go left.
struct BinSplit {
    double weight = kNever;
    std::size_t axis = 0;
    std::uint32_t slice = 0;
};

void chooseBetter(BinSplit& best, const Bins& bins, std::size_t axis, std::uint32_t slices, std::uint32_t count)
{
    std::array<double, kMaxBins> rightWeight;
    LaneBox box;
    std::uint32_t right = 0;
    for (std::uint32_t i = slices; --i > 0;) {
        box.grow(bins.boxes[i]);
        right += bins.counts[i];
        rightWeight[i] = box.computeArea() * right;
    }
    box = {};
    std::uint32_t left = 0;
    for (std::uint32_t i = 1; i < slices; ++i) {
        box.grow(bins.boxes[i - 1]);
        left += bins.counts[i - 1];
        const double weight = box.computeArea() * left + rightWeight[i];
        if (weight < best.weight && left > 0 && left < count) {
            best = {weight, axis, i};
        }
    }
}

// A stable partition.
NodeSplit partition(std::span<Reference> references, std::span<Reference> scratch, const Slices& slices, const BinSplit& split)
{
    std::array<LaneBox, 2> centres;
    std::array<std::uint32_t, 2> counts{};
    for (const Reference reference : references) {
        const Lanes centre = reference.computeCentre();
        const bool right = slices.find(centre, split.axis) >= static_cast<std::int32_t>(split.slice);
        // Writes to both places; the next reference overwrites the wrong one. This is cheaper than a branch that cannot be predicted.
        references[counts[0]] = reference;
        scratch[counts[1]] = reference;
        ++counts[right ? 1 : 0];
        centres[right ? 1 : 0].grow(centre);
    }
    std::copy_n(scratch.begin(), counts[1], references.begin() + counts[0]);
    return {counts[0], {NodeBounds{{}, centres[0]}, NodeBounds{{}, centres[1]}}};
}

NodeSplit splitByBins(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds)
{
    const auto count = static_cast<std::uint32_t>(references.size());
    const std::uint32_t slicesOnAxis = std::min(count, kMaxBins);
    const Slices slices(bounds.centres, slicesOnAxis);
    std::array<Bins, 3> bins;
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
        const auto block = references.subspan(begin, std::min(kBlock, count - begin));
        const Block found = slices.find(block);
        for (std::size_t i = 0; i < block.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                bins[axis].boxes[found[i][axis]].grow(block[i].box);
                ++bins[axis].counts[found[i][axis]];
            }
        }
    }
    BinSplit best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        chooseBetter(best, bins[axis], axis, slicesOnAxis, count);
    }
    if (best.slice == 0) {
        return {};
    }
    NodeSplit split = partition(references, scratch, slices, best);
    for (std::uint32_t i = 0; i < slicesOnAxis; ++i) {
        split.sides[i < best.slice ? 0 : 1].box.grow(bins[best.axis].boxes[i]);
    }
    return split;
}

}  // namespace

NodeSplit splitBySah(std::span<Reference> references, std::span<Reference> scratch, const NodeBounds& bounds)
{
    const double area = bounds.box.computeArea();
    if (!(area > 0.0)) {
        return {};
    }
    return references.size() <= kMaxSwept ? splitBySweep(references, area) : splitByBins(references, scratch, bounds);
}

}  // namespace glim
