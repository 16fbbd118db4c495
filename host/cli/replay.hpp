// glim render SCENE --replay X,Y,SAMPLE
#pragma once

#include "host/cli/render_options.hpp"

namespace glim {

void runReplay(const RenderOptions& options);

}  // namespace glim
