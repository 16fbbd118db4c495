// The invariants of Scene as code.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// Throws InputError on the first violated invariant: finite values, indices in range, unit axes and normals, at least
// one triangle or sphere, primitives that tile the triangles.
void checkScene(const Scene& scene);

}  // namespace glim
