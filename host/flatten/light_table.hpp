// All that emits, as lights that can be chosen in proportion to their power.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

#include <span>

namespace glim {

// Fills lights, emitters, environment and their features of `flat`, and marks the records that emit. `recordOf`: where each
// primitive (triangles, then spheres) stands among flat.records, or the one of its records to mark. Lights without power are left out.
void addLights(FlatScene& flat, const Scene& scene, std::span<const std::uint32_t> recordOf);

}  // namespace glim
