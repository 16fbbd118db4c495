// From a binary tree to a wide one.
#pragma once

#include "host/bvh/wide_bvh.hpp"

#include <thread>

namespace glim {

// The nodes of the binary tree that become nodes or leaves of the wide one are chosen so that the surface-area cost is least.
// The same binary tree gives the same wide one, to the bit, on any number of threads.
WideBvh widenBvh(const Bvh& bvh, unsigned threads = std::thread::hardware_concurrency());

}  // namespace glim
