// Lamps that lie where another surface lies: which of them a ray meets.
#pragma once

#include "host/flatten/primitives.hpp"

namespace glim {

// Where surfaces coincide, rounding would decide which of them a ray meets: lamps look torn, rays miss light that MIS weights trust them to
// find, and shadow rays, which end before a lamp, find the light of all. The order is: lamps before other surfaces, then the lower
// primitive. Adds warnings of what it has changed.
//
// Leaves out emitting triangles in the same place as one that comes before them and hides them, by a hash of their vertices, and spheres
// that an emitting one in the same place hides. Then moves emitting triangles that overlap another triangle in its plane by some roundings
// of their place to their front, those that come first farthest. A double-sided one is moved to both sides, as two triangles. Emission by a
// texture moves nothing, for it may be black there, and neither do double-sided lamps that light passes. Nothing is moved where the search
// would take 1e8 comparisons of boxes.
void liftLamps(const Scene& scene, Primitives& primitives);

}  // namespace glim
