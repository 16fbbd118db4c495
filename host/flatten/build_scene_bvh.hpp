// Builds the BVH of a scene's primitives.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// The box of each primitive, by id; those of spheres are rounded outwards.
std::vector<Box> primitiveBoxes(const Primitives& primitives);

// Builds a tree over the primitives or, with the surface-area heuristic, over their pieces (split_triangles.hpp) if that is cheaper by a
// tenth. `order` then holds each primitive once for each of its pieces.
WideBvh buildSceneBvh(const Primitives& primitives, SplitRule rule = SplitRule::Sah);

// A tree over `primitives` from one by the same rule over `before`. Refits it if only positions differ and its cost grows by a tenth at
// most; else builds it again, but for the trees of shared meshes that are the same.
WideBvh updateSceneBvh(WideBvh previous, const Primitives& before, const Primitives& primitives, SplitRule rule = SplitRule::Sah);

// The same of primitives whose placements alone have changed since.
WideBvh moveInstances(WideBvh previous, const Primitives& primitives, SplitRule rule);

}  // namespace glim
