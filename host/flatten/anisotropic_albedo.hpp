// The directional albedos of the anisotropic GGX lobe, as a table for kernels (shaders/access/albedo_table.glsl).
#pragma once

#include "shaders/shared/scene_types.h"

#include <vector>

namespace glim {

// kAnisotropicAlbedos texels of albedos and kAnisotropicAverageRatios * kAnisotropicAverageAlphas of averages (scene_types.h), by
// quadrature in double, rounded to 2^-22 as makeAlbedoTable does.
std::vector<uvec4> makeAnisotropicAlbedoTable();

}  // namespace glim
