// The invariants of bvh.hpp as code.
#pragma once

#include "host/bvh/bvh.hpp"

#include <optional>
#include <span>
#include <string>

namespace glim {

// Nothing if every invariant holds; otherwise a sentence naming the node and what is wrong.
std::optional<std::string> findBvhDefect(const Bvh& bvh, std::span<const Box> boxes);

}  // namespace glim
