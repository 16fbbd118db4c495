// A bounding volume hierarchy whose nodes have up to eight children, as the kernels traverse it.
#pragma once

#include "host/bvh/bvh.hpp"
#include "shaders/shared/limits.h"

#include <array>

namespace glim {

inline constexpr std::uint32_t kBvhWidth = 8;

// Traversal pushes a node group whenever it descends. It pushes none at the root, which is alone in its group, and none at the last node of
// a path: the stack needs two levels fewer than a path has nodes.
inline constexpr std::uint32_t kMaxWideDepth = kMaxStackLevels + 2;

// An inner node, a leaf of primitives order[first .. first + count), or nothing.
struct WideChild {
    enum class Kind : std::uint8_t { Nothing, Inner, Leaf };

    Kind kind = Kind::Nothing;
    std::uint32_t first = 0;  // inner: index of the node
    std::uint32_t count = 0;  // leaf: number of primitives, at most kMaxLeafRefs
    Box box{};
};

// Invariants, which tests/host/collapse_bvh_test.cpp tests:
//  - nodes[0] is the root; the inner children of a node come after it, one after the other, in the order of their places;
//  - the primitives of a node's leaves follow one another in `order` in the same way; `order` holds every primitive once, or once for each
//    of its pieces (build_scene_bvh.hpp);
//  - a child's box contains the boxes of all that is below it;
//  - no path from the root has more than kMaxWideDepth nodes.
// A child's place is the octant of the node in which it lies, unless another child has that place: bit k is set on the upper side of
// axis k.
struct WideNode {
    std::array<WideChild, kBvhWidth> children;
};

// A node without children that stands for an instance of a shared mesh and leads to its tree.
struct InstanceNode {
    std::uint32_t node;
    std::uint32_t instance;
    std::uint32_t root = 0;  // of the mesh's tree, or a node of it
};

// A part of the arrays: the tree of a shared mesh, whose root is `firstNode`.
struct MeshTree {
    Box box;
    std::uint32_t firstNode;
    std::uint32_t firstEntry;  // in `order`
    std::uint32_t entryCount;
    std::uint32_t depth;
};

struct WideBvh {
    Box box;
    std::vector<WideNode> nodes;
    std::vector<std::uint32_t> order;
    std::vector<InstanceNode> instances;
    std::vector<MeshTree> meshTrees;  // of the meshes that instances share, behind the scene's own tree
    std::uint32_t depth = 0;          // nodes on the longest path
    double cost = 0.0;                // expected node visits + primitive tests of a line that meets the root
};

}  // namespace glim
