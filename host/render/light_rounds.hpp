// Direct light comes in rounds of one ray per path; which ones, in order.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/settings.hpp"

namespace glim {

struct LightRound {
    bool hemisphere = false;         // a direction of the hemisphere, whatever it meets; else a light
    std::uint32_t light;             // index, kAnyLight or kNoLightIndex
    std::uint32_t sample = 0;        // number `sample` of `samples` of this light or of the hemisphere
    std::uint32_t samples = 1;
};

// At least one; the first is no hemisphere. Refuses (InputError) more than a million.
std::vector<LightRound> lightRounds(const FlatScene& scene, const RenderSettings& settings);

}  // namespace glim
