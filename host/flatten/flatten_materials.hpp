// Converts materials and images to the data that kernels read.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/scene/scene.hpp"

namespace glim {

// kLambert ... (shaders/shared/scene_types.h): the simplest that draws the material exactly, textures and vertex colours apart.
std::uint32_t chooseMaterialType(const Material& material);

// Whether light that the material transmits passes it straight, so that shadow rays pass it too: a smooth thin wall whose reflection no
// layer or texture changes.
bool passesStraight(const Material& material);

// Whether light scatters in the solid and gets there through a smooth boundary: lights are then found by rays that leave it, or not at all.
bool scattersBehindSmoothBoundary(const Material& material);

// Fills materials, principled, layers, textures, media and images of `flat`; the images may be those of another time. An image of one
// colour becomes part of the factor that it multiplies. colored[i]: some mesh of material i has vertex colours.
void flattenMaterials(FlatScene& flat, const Scene& scene, const std::vector<bool>& colored);

}  // namespace glim
