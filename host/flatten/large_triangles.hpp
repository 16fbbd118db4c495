// Whether some triangles are so large beside other things that float32 needs care with them (kFeatureLargeTriangles).
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// Elsewhere points are lifted off triangles by some 2^-20 of the triangle's size, and the distance to a hit is known to 2^-22 of it. The
// feature is needed where that is more than 2^-8 of the size of fine primitives, or more than 2^-13 of the distance of a lamp. Sets it, and
// FlatScene::largest.
void findLargeTriangles(FlatScene& flat, const Scene& scene, const Primitives& primitives);

// Those of the scene; and that one where the camera is so near.
FeatureMask featuresSeenBy(const FlatScene& flat, const FlatCamera& camera);

}  // namespace glim
