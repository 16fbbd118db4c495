// An environment map as kernels read it: packed texels, and the cells by which the map is sampled (shaders/access/environment_map.glsl).
#pragma once

#include "host/flatten/flat_scene.hpp"

namespace glim {

// Of a black map only the integral is filled, which is 0.
PackedEnvironment packEnvironmentMap(std::shared_ptr<const RadianceMap> map);

}  // namespace glim
