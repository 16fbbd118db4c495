// Collapses a binary BVH into a wide one.
#pragma once

#include "host/bvh/entries.hpp"
#include "host/bvh/wide_bvh.hpp"

#include <thread>

namespace glim {

// Chooses the binary nodes that become nodes or leaves of the wide tree so that the surface-area cost is least. Frees the binary tree as
// soon as it can. The same binary tree gives the same wide one, to the bit, on any number of threads.
WideBvh collapseBvh(Bvh bvh, const Entries& entries = {}, unsigned threads = std::thread::hardware_concurrency());

}  // namespace glim
