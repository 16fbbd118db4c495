// A map of radiance as kernels read it: packed texels, and the cells by which it is sampled (shaders/access/environment_map.glsl).
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/image/radiance_map.hpp"

namespace glim {

// Fills the environment's part of `flat`. Returns the integral of the map's strongest channel over all directions; 0 if it is black, and
// then nothing else is filled.
double flattenEnvironmentMap(FlatScene& flat, const RadianceMap& map);

}  // namespace glim
