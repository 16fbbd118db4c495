// From a binary tree to a wide one.
#pragma once

#include "host/bvh/wide_bvh.hpp"

namespace glim {

// The nodes of the binary tree that become nodes or leaves of the wide one are chosen so that the surface-area cost is least.
WideBvh widenBvh(const Bvh& bvh);

}  // namespace glim
