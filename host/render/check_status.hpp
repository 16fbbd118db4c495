// Checks whether the kernels could do all their work.
#pragma once

#include "host/render/path_buffers.hpp"

namespace glim {

// Throws DeviceError if the driver cut a loop short or a queue overflowed.
void refuseBrokenStatus(const DeviceDescription& device, const PathBuffers& paths);

}  // namespace glim
