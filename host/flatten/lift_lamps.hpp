// Lamps that lie in the plane of another surface.
#pragma once

#include "host/flatten/primitives.hpp"

namespace glim {

// Moves one-sided emitting triangles that overlap another triangle in its plane by some roundings of their place to their front. Otherwise
// rounding decides which of the two a ray meets: the lamp looks torn, and rays miss light that MIS weights trust them to find. Adds a
// warning if it has moved any. Does nothing where the search would take 1e8 comparisons of boxes.
void liftLamps(const Scene& scene, Primitives& primitives);

}  // namespace glim
