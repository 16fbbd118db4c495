// The directional albedos of the GGX lobe, as a table for kernels (shaders/access/albedo_table.glsl).
#pragma once

#include "shaders/shared/scene_types.h"

#include <vector>

namespace glim {

// (kAlbedoSize + 1) * kAlbedoSize texels of four floats, by quadrature in double. Values are rounded to 2^-22, so that all machines make
// the same table whatever their sine is.
std::vector<uvec4> makeAlbedoTable();

// The table of the sheen lobe: kAlbedoSize^2 texels (fetchSheenAlbedo).
std::vector<uvec4> makeSheenTable();

}  // namespace glim
