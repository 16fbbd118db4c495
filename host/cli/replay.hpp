// glim render SCENE --replay X,Y,SAMPLE
#pragma once

#include "host/job/render_job.hpp"

namespace glim {

void runReplay(const RenderJob& options);

}  // namespace glim
