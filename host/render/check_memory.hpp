// Checks whether a picture fits into memory.
#pragma once

#include "host/gpu/device.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/settings.hpp"

namespace glim {

// To be called before anything is allocated: Linux grants memory that is not there and later kills the program that uses it. Throws
// InputError if the picture does not fit, with its checkpoints if there are to be any.
void checkMemory(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device, bool checkpoints = false);

// How much of that is for light groups.
std::uint64_t computeGroupBytes(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device,
                                bool checkpoints);

}  // namespace glim
