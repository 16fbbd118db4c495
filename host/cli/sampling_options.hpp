// How the picture's samples are taken, as options that write into `settings`; both must outlive the command.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/render/settings.hpp"

namespace CLI {
class App;
}

namespace glim {

void addSampleOptions(CLI::App& command, RenderSettings& settings);    // how many, and which
void addLightOptions(CLI::App& command, RenderSettings& settings);     // what light they carry, and how it is found
void addAdaptiveOptions(CLI::App& command, RenderSettings& settings);  // where a pixel stops
void addTracingOptions(CLI::App& command, RenderSettings& settings, SplitRule& split);

}  // namespace glim
