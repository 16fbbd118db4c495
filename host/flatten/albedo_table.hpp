// The directional albedos of lobes, as tables for kernels (shaders/access/albedo_table.glsl), by quadrature in double.
#pragma once

#include "shaders/shared/scene_types.h"

#include <vector>

namespace glim {

// Of the GGX lobe: (kAlbedoSize + 1) * kAlbedoSize texels.
std::vector<uvec4> makeAlbedoTable();

// The table of the sheen lobe: kAlbedoSize^2 texels (fetchSheenAlbedo).
std::vector<uvec4> makeSheenTable();

// Of the anisotropic GGX lobe: kAnisotropicAlbedos texels of albedos and kAnisotropicAverageRatios * kAnisotropicAverageAlphas of averages
// (scene_types.h).
std::vector<uvec4> makeAnisotropicAlbedoTable();

// Of the GGX lobes of an interface that reflects and refracts: kGlassAlbedos texels, and a texel of averages for each alpha and index
// (scene_types.h).
std::vector<uvec4> makeGlassAlbedoTable();

}  // namespace glim
