#include "host/render/settings.hpp"

#include "host/exact_text.hpp"

#include <cmath>
#include <sstream>

namespace glim {

std::string describeSettings(const RenderSettings& settings)
{
    constexpr const char* kDirect[] = {"mis", "lights", "hemisphere", "bsdf"};
    constexpr const char* kPaths[] = {"all", "emission", "direct", "indirect"};
    constexpr const char* kViews[] = {"shaded", "normal", "depth", "albedo", "bvh-steps"};
    std::ostringstream text;
    text << "seed=" << settings.seed << " bounces=" << settings.bounces
         << " sampler=" << (settings.sampler == Sampler::Sobol ? "sobol" : "independent")
         << " intersector=" << (settings.intersector == Intersector::Watertight ? "watertight" : "moller-trumbore");
    if (settings.direct != DirectLight::Mis) {
        text << " direct=" << kDirect[static_cast<int>(settings.direct)];
    }
    if (settings.lightSamples != 1) {
        text << " light-samples=" << settings.lightSamples;
    }
    if (settings.paths != PathParts::All) {
        text << " paths=" << kPaths[static_cast<int>(settings.paths)];
    }
    if (settings.roulette != Roulette::Throughput) {
        text << " roulette=" << (settings.roulette == Roulette::None ? "none" : "fixed:" + exactText(settings.survival));
    }
    if (settings.view != View::Shaded) {
        text << " view=" << kViews[static_cast<int>(settings.view)];
    }
    if (isNeighbours(settings.adaptive)) {
        text << " adaptive=" << (settings.adaptive == Adaptive::Neighbours ? "neighbours" : "neighbours:absolute");
    }
    if (isCourse(settings.adaptive)) {
        text << " adaptive=" << (settings.adaptive == Adaptive::Course ? "course" : "course:literal")
             << " tolerance=" << exactText(settings.tolerance) << " batch=" << settings.batch
             << " max-spp=" << settings.sampleEnd;
    }
    if (std::isfinite(settings.clampIndirect)) {
        text << " clamp-indirect=" << exactText(settings.clampIndirect);
    }
    return text.str();
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
