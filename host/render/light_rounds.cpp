#include "host/render/light_rounds.hpp"

#include "shaders/shared/path_types.h"

namespace glim {
namespace {

// No direction finds it but by sampling it.
bool isDelta(const FlatLight& light)
{
    return light.kind == kPointLight || light.kind == kSpotLight || light.kind == kDirectionalLight;
}

}  // namespace

std::vector<LightRound> lightRounds(const FlatScene& scene, const RenderSettings& settings)
{
    std::vector<LightRound> rounds;
    if (settings.direct == DirectLight::Mis && !scene.lights.empty()) {
        return {{false, kAnyLight}};
    }
    for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
        const bool delta = isDelta(scene.lights[light]);
        const std::uint32_t samples = delta ? 1 : settings.direct == DirectLight::Lights ? settings.lightSamples : 0;
        for (std::uint32_t i = 0; i < samples; ++i) {
            rounds.push_back({false, light, i, samples});
        }
    }
    if (rounds.empty()) {
        rounds.push_back({false, kNoLightIndex});
    }
    if (settings.direct == DirectLight::Hemisphere && (scene.features.surfaceLights || scene.features.environment)) {
        for (std::uint32_t i = 0; i < settings.lightSamples; ++i) {
            rounds.push_back({true, kNoLightIndex, i, settings.lightSamples});
        }
    }
    return rounds;
}

}  // namespace glim
