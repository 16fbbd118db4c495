// The course's direct light as a list of rounds, each of one ray per path.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/render/settings.hpp"

#include <optional>
#include <string>

namespace glim {

struct LightRound {
    bool hemisphere = false;   // samples a direction of the hemisphere instead of a light
    std::uint32_t light;       // index, kAnyLight or kNoLightIndex
    std::uint32_t sample = 0;  // number `sample` of `samples` of this light or of the hemisphere
    std::uint32_t samples = 1;
};

// What of the scene the course's kernels have no code for, as in "instances that share meshes"; nothing if they know all of it.
std::optional<std::string> missingInCourse(FeatureMask features);

// Returns at least one round; the first is not over the hemisphere. Throws InputError if a hit would need more than a million rays, or if
// the settings ask for the course's kernels and these do not know the scene.
std::vector<LightRound> lightRounds(const FlatScene& scene, const RenderSettings& settings);

}  // namespace glim
