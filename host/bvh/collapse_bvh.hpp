// Collapses a binary BVH into a wide one.
#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <limits>
#include <thread>

namespace glim {

// Chooses the binary nodes that become nodes or leaves of the wide tree so that the surface-area cost is least. The same binary tree gives
// the same wide one, to the bit, on any number of threads.
WideBvh collapseBvh(const Bvh& bvh, unsigned threads = std::thread::hardware_concurrency(),
                    std::uint32_t firstInstance = std::numeric_limits<std::uint32_t>::max());

}  // namespace glim
