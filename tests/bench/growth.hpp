// How the time of a ray grows with the triangles of a scene.
#pragma once

#include "host/gpu/device.hpp"

namespace glim {

// Prints a table: hills of a thousand to ten million triangles, the latter in 5 GiB of memory.
void measureGrowth(Device& device);

}  // namespace glim
