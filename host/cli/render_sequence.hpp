// `glim render`: one picture, or one after another.
#pragma once

#include "host/cli/render_options.hpp"

namespace glim {

// Writes all files of all pictures, and reports on each. In a sequence, a film that is there, whole and of the same scene and settings is
// kept.
ExitCode renderSequence(const RenderOptions& options);

}  // namespace glim
