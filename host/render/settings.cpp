#include "host/render/settings.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

namespace glim {

namespace {

// The shortest text that reads back as the same number.
std::string exactText(float value)
{
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

std::string describeSettings(const RenderSettings& settings)
{
    std::ostringstream text;
    text << "seed=" << settings.seed << " bounces=" << settings.bounces
         << " sampler=" << (settings.sampler == Sampler::Sobol ? "sobol" : "independent")
         << " intersector=" << (settings.intersector == Intersector::Watertight ? "watertight" : "moller-trumbore");
    if (std::isfinite(settings.clampIndirect)) {
        text << " clamp-indirect=" << exactText(settings.clampIndirect);
    }
    return text.str();
}

}  // namespace glim
