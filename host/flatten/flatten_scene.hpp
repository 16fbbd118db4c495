// Converts Scene, Primitives and WideBvh to FlatScene.
#pragma once

#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// `primitives`: those of the scene; `bvh.order` holds each at least once. What `previous` has packed is shared with it: images, environment
// maps, and of the primitives what is the `same`.
FlatScene flattenScene(const Scene& scene, const Primitives& primitives, const WideBvh& bvh, const FlatScene& previous = {},
                       Same same = Same::Nothing);
// Frees the tree's nodes before what takes more is made.
FlatScene flattenScene(const Scene& scene, const Primitives& primitives, WideBvh&& bvh);

// A thin lens, in metres. Radius 0 is a pinhole; its focal distance does not matter.
struct Lens {
    float radius = 0.0F;         // of the aperture
    float focalDistance = 1.0F;  // along the view axis to the plane of focus
};

// As the camera stands at the frame's time, without its motion. `aspectRatio`: width / height of the picture. The picture's height spans
// the camera's vertical extent.
FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens = {});

// The camera with the motion that it has in the scene which was flattened.
FlatCamera setInMotion(FlatCamera flat, const Camera& camera, const FlatScene& scene);

}  // namespace glim
