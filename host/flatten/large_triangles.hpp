// Tells whether a scene has triangles so large beside other things that they need more careful float32 code (kFeatureLargeTriangles).
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// Without the feature, points are lifted off a triangle by some 2^-20 of its size, and the distance to a hit is known to 2^-22 of its size.
// The feature is needed if the lift is more than 2^-8 of the size of fine primitives, or more than 2^-13 of the distance from a triangle to
// a light. Sets FlatScene::largest, and the feature among those of the surfaces if it is the sizes that need it.
void findLargeTriangles(FlatScene& flat, const Primitives& primitives);

// Whether it is a light that needs it.
bool areLightsClose(const FlatScene& flat, const Scene& scene);

// The features of the scene, and kFeatureLargeTriangles too if the camera is that close to a large triangle.
FeatureMask featuresSeenBy(const FlatScene& flat, const FlatCamera& camera);

}  // namespace glim
