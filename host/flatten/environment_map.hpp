// A map of radiance as kernels read it: packed texels, and the cells by which it is sampled (shaders/access/environment_map.glsl).
#pragma once

#include "host/flatten/flat_scene.hpp"

namespace glim {

// Fills the part of `flat` that is of an environment map, unless it is of this one already. Of a black map only the integral is filled,
// which is 0.
void flattenEnvironmentMap(FlatScene& flat, std::shared_ptr<const RadianceMap> map);

}  // namespace glim
