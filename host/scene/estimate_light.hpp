// Whether a scene's own lights show what is in it.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// Whether an environment, a punctual light or a surface is there to light the scene. Emission without KHR_materials_emissive_strength is
// that of displays and indicators, and is not.
bool hasLight(const Scene& scene);

// The share of the surfaces that the camera sees which the scene's punctual lights and lamps show: those on which a diffuse grey would be
// as bright as a fiftieth of white. An estimate of 64x64 pixels, without shadows and light from other surfaces; which way a surface faces
// does not count either. Mirrors and clear glass are dark under lamps, since they show what is around them. Surfaces that emit and unlit
// ones do not count; the share of nothing is 1.
double estimateLitShare(const Scene& scene, const Camera& camera);

}  // namespace glim
