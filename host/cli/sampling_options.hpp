// How the picture's samples are taken, as options that write into `settings`; both must outlive the command.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/render/settings.hpp"

#include <string>

namespace CLI {
class App;
}

namespace glim {

// How many, and which; the defaults as the help names them.
void addSampleOptions(CLI::App& command, RenderSettings& settings, const std::string& sppDefault, const std::string& rangeDefault);
void addSamplerOptions(CLI::App& command, RenderSettings& settings);   // of them, which random numbers
void addLightOptions(CLI::App& command, RenderSettings& settings);     // what light they carry, and how it is found
void addAdaptiveOptions(CLI::App& command, RenderSettings& settings);  // where a pixel stops
void addTracingOptions(CLI::App& command, RenderSettings& settings, SplitRule& split);

}  // namespace glim
