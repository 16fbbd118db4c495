// Checks options against each other.
#pragma once

#include "host/cli/render_options.hpp"

namespace glim {

// Each refuses (UsageError) options that contradict each other or mean nothing together. Then it sets what follows from the
// options that were given: the default number of samples, the sampler of --adaptive, the bounces of a --view.
void resolvePicture(const Command& command, PictureOptions& options);
void resolveRender(const Command& command, RenderOptions& options);
// The part of resolvePicture that concerns light transport and the device.
void resolveLight(const Command& command, PictureOptions& options);

// Refuses --animation without a time.
void resolveAnimation(const Command& command, bool hasTime);

// The largest number of samples per pixel: the sampler counts samples of lights in 32 bits.
std::uint32_t mostSamples(const RenderSettings& settings);

}  // namespace glim
