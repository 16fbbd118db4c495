// Which nodes of a file hide all but one of what it draws.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"

#include <cstddef>
#include <optional>
#include <set>

namespace glim {

// Nodes that, when they are invisible, hide each of `drawn` that can be hidden without `kept`, what hangs below that, and the file's
// punctual lights. They are as near to the roots as can be.
std::set<std::size_t> nodesToHide(const tinygltf::Model& model, const std::set<std::size_t>& drawn, std::optional<std::size_t> kept);

}  // namespace glim
