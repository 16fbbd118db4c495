// What the options of `render` mean together.
#pragma once

#include "host/cli/render_options.hpp"

namespace glim {

// Refuses (CLI::ValidationError) options that contradict each other or mean nothing together, and sets what follows from those
// that were given: the default number of samples, the sampler of --adaptive, the bounces of a --view.
void settleOptions(const CLI::App& command, RenderOptions& options);

}  // namespace glim
