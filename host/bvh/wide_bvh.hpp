// A bounding volume hierarchy whose nodes have up to eight children: what kernels walk.
#pragma once

#include "host/bvh/bvh.hpp"
#include "shaders/shared/limits.h"

#include <array>

namespace glim {

inline constexpr std::uint32_t kBvhWidth = 8;

// A walk puts siblings on its stack where it goes on to children: not at the root, which has no siblings, and not at the path's end.
inline constexpr std::uint32_t kMaxWideDepth = kMaxStackLevels + 2;

// An inner node, a leaf of primitives order[first .. first + count), or nothing.
struct WideChild {
    enum class Kind : std::uint8_t { Nothing, Inner, Leaf };

    Kind kind = Kind::Nothing;
    std::uint32_t first = 0;  // inner: index of the node
    std::uint32_t count = 0;  // of the leaf's primitives, at most kMaxLeafRecords
    Box box{};
};

// Invariants, held as code by tests/host/widen_bvh_test.cpp:
//  - nodes[0] is the root; the inner children of a node follow one another, in the order of their places, after itself;
//  - so do the primitives of its leaves in `order`, in which every primitive is once, or once for each of its pieces (build_scene_bvh.hpp);
//  - a child's box contains the boxes of all that is below it;
//  - no path from the root has more than kMaxWideDepth nodes.
// A child's place is the octant of its node that it lies in, as far as there is room: bit k is set on the upper side of axis k.
struct WideNode {
    std::array<WideChild, kBvhWidth> children;
};

struct WideBvh {
    Box box;
    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> order;
    std::uint32_t depth = 0;  // nodes on the longest path
    double cost = 0.0;        // expected node visits + primitive tests of a line that meets the root
};

}  // namespace glim
