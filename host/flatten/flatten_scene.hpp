// Scene and WideBvh to FlatScene.
#pragma once

#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

namespace glim {

// `bvh.order`: of the scene's primitives, each at least once.
FlatScene flattenScene(const Scene& scene, const WideBvh& bvh);

// A thin lens; both in metres. Radius 0 is a pinhole, whose focal distance does not matter.
struct Lens {
    float radius = 0.0F;         // of the aperture
    float focalDistance = 1.0F;  // along the view axis to the plane of sharpness
};

// `aspectRatio`: width / height of the picture. The picture's height spans the camera's vertical extent.
FlatCamera flattenCamera(const Camera& camera, float aspectRatio, const Lens& lens = {});

}  // namespace glim
