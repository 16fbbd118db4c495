// What stands behind the boxes that a tree is built over.
#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

namespace glim {

inline constexpr std::uint32_t kMaxDepthOfEntry = 8;
static_assert((kMaxBvhDepth + 2) / 3 + kMaxDepthOfEntry <= kMaxWideDepth, "if each wide node covers three levels of the binary tree");

// A box is that of a primitive or, in this order, of a tree or of an instance.
struct Entries {
    std::span<const std::uint32_t> single = {};  // the primitive of each box before the trees; empty: they are numbered as the boxes are
    std::uint32_t firstTree = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t firstInstance = std::numeric_limits<std::uint32_t>::max();
    // Called once for each tree, by number, one after the other, so that no two are there at once: one over further primitives, of at most
    // kMaxDepthOfEntry levels.
    std::function<WideBvh(std::uint32_t)> makeTree = {};
    std::size_t inTrees = 0;  // how many primitives

    bool isInstance(std::uint32_t entry) const { return entry >= firstInstance; }
    bool isTree(std::uint32_t entry) const { return entry >= firstTree && entry < firstInstance; }
    std::uint32_t getSingle(std::uint32_t entry) const { return single.empty() ? entry : single[entry]; }
};

}  // namespace glim
