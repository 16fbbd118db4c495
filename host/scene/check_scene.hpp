// Tests the invariants of a Scene.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// Throws InputError on the first violated invariant: finite values, indices in range, unit axes, transforms that can be inverted, at
// least one instance or sphere.
void checkScene(const Scene& scene);

}  // namespace glim
