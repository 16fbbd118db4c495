// The course's direct light as a list of rounds, each of one ray per path.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/settings.hpp"

namespace glim {

struct LightRound {
    bool hemisphere = false;   // samples a direction of the hemisphere instead of a light
    std::uint32_t light;       // index, kAnyLight or kNoLightIndex
    std::uint32_t sample = 0;  // number `sample` of `samples` of this light or of the hemisphere
    std::uint32_t samples = 1;
};

// Returns at least one round; the first is not over the hemisphere. Throws InputError if a hit would need more than a million rays.
std::vector<LightRound> lightRounds(const FlatScene& scene, const RenderSettings& settings);

}  // namespace glim
