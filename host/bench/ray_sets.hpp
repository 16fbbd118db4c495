// Rays as kernels make them, to time the kernels that trace them.
#pragma once

#include "host/render/wavefront.hpp"

namespace glim {

struct RaySets {
    std::vector<PathRay> primary;   // of the camera
    std::vector<PathRay> diffuse;   // of the first bounce
    std::vector<ShadowRay> shadow;  // from what the camera sees to a light
};

// Those of the first sample of every pixel of the slab, which must be no more than the settings' pathCapacity.
RaySets captureRays(Wavefront& wavefront, const Slab& slab);

}  // namespace glim
