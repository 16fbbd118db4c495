// The faster schedule of a device, measured once and kept by device and driver in schedules.json in $GLIM_CACHE_DIR, $XDG_CACHE_HOME/glim
// or ~/.cache/glim; another version of glim measures it again. If anything is wrong with that file, it counts as missing: no bit of a
// picture depends on it.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/device.hpp"
#include "host/render/settings.hpp"

namespace glim {

// Auto if it was not measured.
Schedule rememberedSchedule(const DeviceDescription& device);

// Measures it if it is unknown, provided that this takes little of the picture's time and can be kept.
Schedule fastestSchedule(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
