// Whether some triangles are so large beside other things that float32 needs care with them.
#pragma once

#include "host/flatten/primitives.hpp"

namespace glim {

// Elsewhere points are lifted off triangles by some 2^-20 of the triangle's size, and the distance to a hit is known to 2^-22 of it. True
// if that is more than 2^-8 of the size of fine primitives, or more than 2^-13 of the distance of a camera or a lamp.
bool hasLargeTriangles(const Scene& scene, const Primitives& primitives);

}  // namespace glim
