// Tests the invariants that bvh.hpp lists.
#pragma once

#include "host/bvh/bvh.hpp"

#include <optional>
#include <span>
#include <string>

namespace glim {

// Returns nothing if every invariant holds, otherwise a sentence that names the node and what is wrong.
std::optional<std::string> findBvhDefect(const Bvh& bvh, std::span<const Box> boxes);

}  // namespace glim
