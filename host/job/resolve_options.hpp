// Checks options against each other.
#pragma once

#include "host/job/render_job.hpp"

namespace glim {

// Each refuses (UsageError) options that contradict each other or mean nothing together. Then it sets what follows from the options that
// were given: the default number of samples, the sampler of --adaptive, the bounces of a --view.
void resolvePicture(const OptionTable& table, PictureOptions& picture);
void resolveRender(const OptionTable& table, RenderJob& job);
// The part of resolvePicture that concerns light transport and the device.
void resolveLight(const OptionTable& table, const PictureOptions& picture);

// Refuses --animation without a time.
void resolveAnimation(const OptionTable& table, bool hasTime);

// The largest number of samples per pixel: the sampler counts samples of lights in 32 bits.
std::uint32_t maxSamples(const RenderSettings& settings);

}  // namespace glim
