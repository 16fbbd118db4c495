#include "host/render/course_rounds.hpp"

#include "host/error.hpp"
#include "host/render/course.hpp"
#include "shaders/shared/course_types.h"

#include <algorithm>

namespace glim {
namespace {

// Whether no ray can hit the light, so that it must be sampled.
bool isDelta(const FlatLight& light) { return light.kind == kPointLight || light.kind == kSpotLight || light.kind == kDirectionalLight; }

void refuseTooMany(const FlatScene& scene, const RenderSettings& settings)
{
    constexpr std::uint64_t kMax = 1U << 20;
    const auto deltas = static_cast<std::uint64_t>(std::count_if(scene.lights.begin(), scene.lights.end(), isDelta));
    const std::uint64_t rays = deltas + (scene.lights.size() - deltas) * settings.course.lightSamples;
    if (settings.course.direct == DirectLight::Lights && rays > kMax) {
        throw InputError(MessageId::TooLarge,
                         {part::place("--direct"), " lights: the scene's ", std::to_string(scene.lights.size()), " lights with ",
                          std::to_string(settings.course.lightSamples), " samples each would take ", part::value(std::to_string(rays)),
                          " rays per hit, expected ", part::expected("at most " + std::to_string(kMax)), "."});
    }
}

void refuseMissing(const FlatScene& scene, const RenderSettings& settings)
{
    const std::optional<std::string> missing = missingInCourse(scene.features);
    if (missing && usesCourseEstimators(settings)) {
        throw InputError(MessageId::Unsupported,
                         {"the scene has ", part::value(*missing), ", which the course's estimators do not know; expected ",
                          part::expected("the defaults of --direct, --roulette, --accelerator and --intersector"), "."});
    }
}

}  // namespace

std::optional<std::string> missingInCourse(FeatureMask features)
{
    if ((features & kFeatureAlpha) != 0) {
        return "surfaces that are transparent in places";
    }
    if ((features & kFeatureMedia) != 0) {
        return "solids that absorb light or lie within each other";
    }
    return (features & kFeatureInstances) != 0 ? std::optional<std::string>("instances that share meshes") : std::nullopt;
}

std::vector<LightRound> lightRounds(const FlatScene& scene, const RenderSettings& settings)
{
    refuseMissing(scene, settings);
    refuseTooMany(scene, settings);
    std::vector<LightRound> rounds;
    if (settings.course.direct == DirectLight::Mis && !scene.lights.empty()) {
        return {{false, kAnyLight}};
    }
    for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
        const bool delta = isDelta(scene.lights[light]);
        const std::uint32_t samples = delta ? 1 : settings.course.direct == DirectLight::Lights ? settings.course.lightSamples : 0;
        for (std::uint32_t i = 0; i < samples; ++i) {
            rounds.push_back({false, light, i, samples});
        }
    }
    if (rounds.empty()) {
        rounds.push_back({false, kNoLightIndex});
    }
    constexpr FeatureMask kHitByRays = kFeatureTriangleLights | kFeatureRectangleLights | kFeatureSphereLights | kFeatureEnvironment;
    if (settings.course.direct == DirectLight::Hemisphere && (scene.features & kHitByRays) != 0) {
        for (std::uint32_t i = 0; i < settings.course.lightSamples; ++i) {
            rounds.push_back({true, kNoLightIndex, i, settings.course.lightSamples});
        }
    }
    return rounds;
}

}  // namespace glim
