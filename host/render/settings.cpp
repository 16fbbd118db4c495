#include "host/render/settings.hpp"

#include "host/text.hpp"
#include "shaders/shared/pixel_moments.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace glim {

glm::uvec2 pilotSize(const RenderSettings& settings, double pixels)
{
    const double scale = std::sqrt(pixels / (static_cast<double>(settings.width) * settings.height));
    const auto sideOf = [&](std::uint32_t side) { return static_cast<std::uint32_t>(std::max(1.0, std::round(scale * side))); };
    return {sideOf(settings.width), sideOf(settings.height)};
}

glm::uvec2 pilotSizeAtMost(const RenderSettings& settings, double pixels)
{
    return pilotSize(settings, std::min(pixels, static_cast<double>(settings.width) * settings.height));
}

RenderSettings pilotSettings(const RenderSettings& settings, const glm::uvec2& size)
{
    RenderSettings pilot;
    pilot.width = size.x;
    pilot.height = size.y;
    pilot.bounces = settings.bounces;
    pilot.sampler = settings.sampler;
    pilot.caustics = settings.caustics;
    pilot.schedule = settings.schedule;
    pilot.workgroup = settings.workgroup;
    return pilot;
}

std::string describeSettings(const RenderSettings& settings)
{
    constexpr const char* kDirect[] = {"mis", "lights", "hemisphere", "bsdf"};
    constexpr const char* kPaths[] = {"all", "emission", "direct", "indirect"};
    constexpr const char* kAovs[] = {"shaded", "normal", "depth", "albedo", "bvh-steps", "guide", "samples"};
    std::ostringstream text;
    text << "seed=" << settings.seed << " bounces=" << settings.bounces
         << " sampler=" << (settings.sampler == Sampler::Sobol ? "sobol" : "independent")
         << " intersector=" << (settings.course.intersector == Intersector::Watertight ? "watertight" : "moller-trumbore");
    if (settings.course.direct != DirectLight::Mis) {
        text << " direct=" << kDirect[static_cast<int>(settings.course.direct)];
    }
    if (settings.course.lightSamples != 1) {
        text << " light-samples=" << settings.course.lightSamples;
    }
    if (settings.paths != PathParts::All) {
        text << " paths=" << kPaths[static_cast<int>(settings.paths)];
    }
    if (settings.course.roulette != Roulette::Throughput) {
        text << " roulette=" << (settings.course.roulette == Roulette::None ? "none" : "fixed:" + exactText(settings.course.survival));
    }
    if (settings.aov != Aov::Radiance) {
        text << " view=" << kAovs[static_cast<int>(settings.aov)];
    }
    if (isNeighbours(settings.adaptive)) {
        text << " adaptive=" << (settings.adaptive == Adaptive::Neighbours ? "neighbours" : "neighbours:absolute");
    }
    if (isCourse(settings.adaptive)) {
        text << " adaptive=" << (settings.adaptive == Adaptive::Course ? "course" : "course:literal")
             << " tolerance=" << exactText(settings.course.tolerance) << " batch=" << settings.course.batch
             << " max-spp=" << settings.sampleEnd;
    }
    if (std::isfinite(settings.clampIndirect)) {
        text << " clamp-indirect=" << exactText(settings.clampIndirect);
    }
    if (!settings.caustics) {
        text << " caustics=off";
    }
    if (settings.guide) {
        text << " guide=" << settings.guide->digest;
    }
    if (settings.catcher) {
        text << " catcher=" << (settings.catcherReflections ? "on" : "shadows");
    }
    if (!settings.lightGroups.empty()) {
        const char* separator = " light-groups=";
        for (const std::string& name : settings.lightGroups) {
            text << std::exchange(separator, ",") << name;
        }
    }
    return text.str();
}

std::uint32_t RenderSettings::tileSize() const
{
    const std::uint64_t bytes = sumsOfGroups(groupCount()) * sizeof(glm::vec3);
    return bytes == 0 ? tilePixels : std::min(tilePixels, static_cast<std::uint32_t>(kMostOfBuffer / bytes));
}

std::string findSetting(const std::string& description, const std::string& name)
{
    std::istringstream words(description);
    const std::string start = name + "=";
    for (std::string word; words >> word;) {
        if (word.rfind(start, 0) == 0) {
            return word.substr(start.size());
        }
    }
    return {};
}

}  // namespace glim
