// The costs from which collapse_bvh.cpp chooses the binary nodes to keep.
#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMaxRoots = kBvhWidth - 1;

// What the dynamic program knows of a binary subtree.
struct Subtree {
    std::array<float, kMaxRoots> cost;           // [i]: least surface-area cost as a forest of at most i + 1 roots
    std::array<std::uint8_t, kMaxRoots> toLeft;  // how many of these roots are on the left side; 0: fewer are as cheap, or this is a leaf
    std::uint8_t nodeToLeft;                     // the same for the kBvhWidth children of a node
    bool isLeaf;                                 // a single root is cheapest as a leaf
    bool hasInstance;                            // it holds an instance, which must be a leaf of its own
    std::uint8_t height;                         // inner nodes on the longest path, in the binary tree
    std::uint32_t first, count;                  // primitives
};

// Returns one entry per node of the tree. Primitives from `firstInstance` on are instances. Ylitie, Karras, Laine, "Efficient Incoherent
// Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.2: for each binary node and each i, the least cost of a forest
// of at most i roots that covers its subtree.
std::vector<Subtree> examineSubtrees(const Bvh& bvh, unsigned threads, std::uint32_t firstInstance);

}  // namespace glim
