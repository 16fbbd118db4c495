// Builds a binary BVH over boxes by one of three rules.
#pragma once

#include "host/bvh/bvh.hpp"

#include <thread>
#include <vector>

namespace glim {

// Where a node is split. Mean and Median split along the axis on which the boxes' centres spread most, down to leaves of at most
// `leafSize` primitives: two, as in Berkeley's course CS 184.
enum class SplitRule {
    Sah,     // the cheapest by the surface-area heuristic: of all splits of at most 4 primitives, else of those between 32 bins per axis
    Mean,    // at the mean of the centres, or at their median if the mean leaves a side empty
    Median,  // the same number of primitives on both sides
};

// Takes one box per primitive, at least one; boxes are finite with lo <= hi. Frees them once it has read them. The same boxes give the same
// tree, to the bit, on any number of threads.
Bvh buildBvh(std::vector<Box> boxes, SplitRule rule = SplitRule::Sah, unsigned threads = std::thread::hardware_concurrency(),
             std::uint32_t leafSize = 2);

// The upper part of such a tree: what has at most `most` primitives is not split.
Bvh divide(std::vector<Box> boxes, SplitRule rule, unsigned threads, std::uint32_t most);

}  // namespace glim
