// From a scene to its tree.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/wide_bvh.hpp"
#include "host/scene/scene.hpp"

namespace glim {

// The box of each primitive, triangles first, then spheres (rounded outwards): what buildBvh takes.
std::vector<Box> primitiveBoxes(const Scene& scene);

// The tree of the primitives or, by the surface-area heuristic, of their pieces (split_triangles.hpp) where that is cheaper by a
// tenth. `order` holds each primitive as many times as it has pieces.
WideBvh buildSceneBvh(const Scene& scene, SplitRule rule = SplitRule::Sah);

}  // namespace glim
