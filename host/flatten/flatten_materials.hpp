// Materials and images to the records that kernels read.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

namespace glim {

// kLambert, kMirror, kDielectric or kPrincipled: the simplest that draws the material exactly, textures and vertex colours apart.
std::uint32_t lobeOf(const Material& material);

// Fills materials, principled, textures and texels of `flat`. An image of one colour becomes part of the factor that it multiplies.
// colored[i]: some mesh of material i has vertex colours.
void flattenMaterials(FlatScene& flat, const Scene& scene, const std::vector<bool>& colored);

// What the material needs of the kernels.
std::uint32_t featuresOf(const FlatScene& flat, std::uint32_t material);

}  // namespace glim
