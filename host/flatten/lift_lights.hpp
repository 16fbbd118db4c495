// Lights that coincide with another surface: decides which of the surfaces a ray meets.
#pragma once

#include "host/flatten/primitives.hpp"

namespace glim {

// Where surfaces coincide, rounding would decide which of them a ray meets: lights look torn, rays miss light that MIS weights trust them
// to find, and shadow rays, which end before a light, find the light of all. The order is: lights before other surfaces, then the
// primitive with the lower index. Adds warnings of what it has changed.
//
// First leaves out emitting triangles with the vertices of an earlier emitting one that hides them, and spheres that a coincident emitting
// sphere hides. Then moves each emitting triangle that overlaps a coplanar one towards its front, by some roundings of its coordinates.
// Triangles with lower indices move farther. A double-sided one becomes two triangles, one moved to each side. Triangles with an emissive
// texture do not move, because the texture may be black there. Double-sided lights that let light through do not move either. Nothing moves
// if the search would take more than 1e8 comparisons of boxes.
void liftLights(const Scene& scene, Primitives& primitives);

}  // namespace glim
