// Measures which schedule is faster on a device.
#pragma once

#include "host/render/renderer.hpp"

#include <vector>

namespace glim {

// Renders the whole picture again, from the same random numbers. Returns the seconds it took.
double timeRender(Renderer& renderer, const FlatCamera& camera);

// False if a schedule was asked for by name, or if one of them cannot render these settings.
bool canMeasureSchedules(const RenderSettings& settings);

// Samples per second of device time, an entry for each round.
struct ScheduleRates {
    std::vector<double> wavefront, persistent;

    // Auto unless one was faster by kScheduleMargin in every round: of two that are equally fast, one is ahead in five rounds in one case
    // of 16, and hardly by that much.
    Schedule fastest() const;
};
inline constexpr double kScheduleMargin = 1.05;

// Renders the scene by both in turn, which canMeasureSchedules must allow; without entries if the device does not tell its time.
ScheduleRates measureSchedules(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
