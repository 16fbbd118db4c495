// What options mean together.
#pragma once

#include "host/cli/render_options.hpp"

namespace glim {

// Refuse (CLI::ValidationError) options that contradict each other or mean nothing together, and set what follows from those
// that were given: the default number of samples, the sampler of --adaptive, the bounces of a --view.
void settlePicture(const CLI::App& command, PictureOptions& options);
void settleLight(const CLI::App& command, PictureOptions& options);  // of it, what addLightOptions and addTracingOptions add
void settleRender(const CLI::App& command, RenderOptions& options);

// Per pixel, since the sampler counts samples of lights in 32 bits.
std::uint32_t mostSamples(const RenderSettings& settings);

}  // namespace glim
