// The faster schedule of a device, measured once. It is kept by device and driver in schedules.json in $GLIM_CACHE_DIR,
// $XDG_CACHE_HOME/glim or ~/.cache/glim; another version of glim measures again. If anything is wrong with that file, it counts as missing:
// no bit of a picture depends on it. A software device is never measured, because other programs use its CPU too. It always takes the
// persistent schedule (tests/bench/README.md).
#pragma once

#include "host/render/measure_schedules.hpp"

#include <functional>

namespace glim {

// Auto if it was not measured, and for software devices.
Schedule rememberedSchedule(const DeviceDescription& device);

// Measures it if it is unknown, provided that this takes little of the picture's time and can be kept. What is within the noise is not
// kept.
Schedule fastestSchedule(const DeviceDescription& device, const RenderSettings& settings, const std::function<ScheduleRates()>& measure);

}  // namespace glim
