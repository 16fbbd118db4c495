// From boxes to their tree, by one of three rules.
#pragma once

#include "host/bvh/bvh.hpp"

#include <span>
#include <thread>

namespace glim {

// Where a node is divided. Mean and Median: along the axis on which the boxes' centres spread most, down to leaves of at most
// two primitives, as Berkeley's course CS 184 has it.
enum class SplitRule {
    Sah,     // the cheapest of 32 places on each axis, or of all for up to 8 primitives, by the surface-area heuristic
    Mean,    // the mean of the centres; their median where one side would be empty
    Median,  // as many primitives on either side
};

// One box per primitive, finite with lo <= hi, at least one. The same boxes give the same tree, to the bit, on any number of
// threads.
Bvh buildBvh(std::span<const Box> boxes, SplitRule rule = SplitRule::Sah,
             unsigned threads = std::thread::hardware_concurrency());

}  // namespace glim
