// Which nodes of a binary tree stay when it becomes a wide one.
#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMostRoots = kBvhWidth - 1;

// What is known of the part of a binary tree below a node.
struct Subtree {
    std::array<float, kMostRoots> cost;           // of a forest of at most i + 1 roots
    std::array<std::uint8_t, kMostRoots> toLeft;  // of these roots on the left side; 0: fewer roots are as good, or a leaf
    std::uint8_t nodeToLeft;                      // of a node's kBvhWidth children
    bool isLeaf;                                  // as a single root
    std::uint8_t height;                          // inner nodes on the longest path, in the binary tree
    std::uint32_t first, count;                   // primitives
};

// Of each node of the tree. Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
// HPG 2017, section 3.2: for each binary node and each i, the least cost of what is below as a forest of at most i roots.
std::vector<Subtree> examineSubtrees(const Bvh& bvh, unsigned threads);

}  // namespace glim
