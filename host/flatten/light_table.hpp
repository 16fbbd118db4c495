// The scene's lights.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

#include <span>

namespace glim {

// Fills lights, their tree, environment and their features of `flat`, and marks the records that emit. `recordOf` is the record of each
// primitive, or the one to mark if it has several. Lights without power are left out.
void addLights(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> recordOf);

}  // namespace glim
