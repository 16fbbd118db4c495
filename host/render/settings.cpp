#include "host/render/settings.hpp"

#include <cmath>
#include <sstream>

namespace glim {

std::string describeSettings(const RenderSettings& settings)
{
    std::ostringstream text;
    text << "seed=" << settings.seed << " bounces=" << settings.bounces
         << " sampler=" << (settings.sampler == Sampler::Sobol ? "sobol" : "independent")
         << " intersector=" << (settings.intersector == Intersector::Watertight ? "watertight" : "moller-trumbore");
    if (std::isfinite(settings.clampIndirect)) {
        text << " clamp-indirect=" << settings.clampIndirect;
    }
    return text.str();
}

}  // namespace glim
