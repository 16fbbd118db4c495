// The table of a scene's lights.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

#include <span>

namespace glim {

// Fills lights, their marks and tree, environment and their features of `flat`. `refOfPrimitive` is a reference of each primitive; nothing
// asks for it if no material emits. Lights without power are left out. Of `flat` the emissionMeans may be those of another scene.
void addLights(FlatScene& flat, const Scene& scene, const Primitives& primitives, std::span<const std::uint32_t> refOfPrimitive);

}  // namespace glim
