// The faster schedule of a device, measured once and kept by device and driver in schedules.json in $GLIM_CACHE_DIR, $XDG_CACHE_HOME/glim
// or ~/.cache/glim; another version of glim measures it again. Whatever is wrong with that file, it is as if there were none: no bit
// of a picture depends on it.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/device.hpp"
#include "host/render/settings.hpp"

namespace glim {

// Auto if it was not measured.
Schedule rememberedSchedule(const DeviceDescription& device);

// Measures it if it was not, where that takes little of what the picture takes and can be kept.
Schedule fastestSchedule(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
