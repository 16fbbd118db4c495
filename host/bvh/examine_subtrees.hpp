// The costs from which collapse_bvh.cpp chooses the binary nodes to keep.
#pragma once

#include "host/bvh/entries.hpp"
#include "host/bvh/wide_bvh.hpp"

#include <cstdint>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMaxRoots = kBvhWidth - 1;

// What the dynamic program has chosen for a binary subtree.
struct Subtree {
    std::uint32_t toLeft : 3 * kMaxRoots;  // see getToLeft
    std::uint32_t nodeToLeft : 3;          // how many of the kBvhWidth children of a node are on the left side
    std::uint32_t height : 7;              // inner nodes on the longest path, in the binary tree; a level of an entry's tree is three
    std::uint32_t isLeaf : 1;              // a single root is cheapest as a leaf
    std::uint32_t isAlone : 1;             // it holds a tree or an instance, which must not be in a leaf with others
    std::uint32_t count : 31;              // entries

    // How many of so many roots are on the left side; 0: fewer are as cheap, or this is a leaf.
    std::uint32_t getToLeft(std::uint32_t roots) const { return toLeft >> 3 * (roots - 1) & 7U; }
};

static_assert(kMaxRoots <= 7 && kMaxBvhDepth + 3 * kMaxDepthOfEntry < 128 && sizeof(Subtree) == 8);

// Returns one element per node of the tree. Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
// BVHs", HPG 2017, section 3.2: for each binary node and each i, the least cost of a forest of at most i roots that covers its subtree.
std::vector<Subtree> examineSubtrees(const Bvh& bvh, unsigned threads, const Entries& entries);

}  // namespace glim
