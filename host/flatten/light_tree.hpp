// The light tree, by which finite lights are sampled (pbrt's BVHLightSampler, with eight children per node).
#pragma once

#include "shaders/shared/scene_types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glim {

// Where a light is, and which way it shines.
struct LightBounds {
    vec3 low, high;            // box, metres
    float radius = 0.0F;       // of a sphere around the box's centre that holds the light
    vec3 axis{0.0F};           // unit normal or direction; 0: light leaves in every direction
    float power = 0.0F;        // radiance * projected area, or intensity, W/sr; above 0
    float cosEmission = 0.0F;  // of the angle from the axis at which the light ends
    bool twoSided = false;
};

struct LightTree {
    std::vector<LightNode> nodes;      // as scene_types.h says
    std::vector<std::uint32_t> order;  // the light at each leaf, from the first to the last
    std::vector<uvec4> powers;         // as scene_types.h says; empty without clusters
};

// Takes at least one light. sceneRadius: half of the diagonal of the scene's box, metres. Conty Estevez and Kulla, "Importance Sampling of
// Many Lights with Adaptive Tree Splitting", 2018, section 4.
LightTree buildLightTree(std::span<const LightBounds> lights, float sceneRadius);

}  // namespace glim
