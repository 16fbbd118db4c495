// A bounding volume hierarchy over boxes; it does not know what the boxes hold.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMaxBvhDepth = 48;

struct Box {
    glm::vec3 lo;
    glm::vec3 hi;
};

inline constexpr Box kEmptyBox{glm::vec3(std::numeric_limits<float>::infinity()), glm::vec3(-std::numeric_limits<float>::infinity())};

inline Box unite(const Box& a, const Box& b) { return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)}; }

// To the next float on every side.
inline Box roundOutwards(Box box)
{
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::nextafter(box.lo[k], kEmptyBox.hi[k]);
        box.hi[k] = std::nextafter(box.hi[k], kEmptyBox.lo[k]);
    }
    return box;
}

// Each bound is halved first, because their sum could overflow.
inline glm::vec3 computeCentre(const Box& box) { return 0.5F * box.lo + 0.5F * box.hi; }

// Invariants, which check_bvh.hpp tests:
//  - nodes[0] is the root; an inner node (count == 0) has its children at `first` and `first + 1`, after itself;
//  - nodes are in depth-first order: after a node come its two children, then all below the first child, then all below the second;
//  - a leaf holds primitives order[first .. first + count), count >= 1;
//  - every primitive is in exactly one leaf; a node's box contains the boxes of all that is below it;
//  - no path from the root has more than kMaxBvhDepth inner nodes, whatever the input: the builder changes to median splits in time.
struct BvhNode {
    Box box;
    std::uint32_t first;
    std::uint32_t count;
};

struct Bvh {
    std::vector<BvhNode> nodes;
    std::vector<std::uint32_t> order;  // primitive indices, leaf after leaf
    std::uint32_t depth = 0;           // inner nodes on the longest path
    double cost = 0.0;                 // surface-area cost relative to the root: expected node visits + primitive tests
};

}  // namespace glim
