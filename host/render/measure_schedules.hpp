// Measures which schedule is faster on a device.
#pragma once

#include "host/render/renderer.hpp"

namespace glim {

// Renders the whole picture again, from the same random numbers. Returns the seconds it took.
double timeRender(Renderer& renderer, const FlatCamera& camera);

// False if a schedule was asked for by name, or if one of them cannot render these settings.
bool canMeasureSchedules(const RenderSettings& settings);

// Samples per second.
struct ScheduleRates {
    double wavefront, persistent;

    Schedule fastest() const { return persistent > wavefront ? Schedule::Persistent : Schedule::Wavefront; }
};

// Renders the scene by both in turn, which canMeasureSchedules must allow. On two cores without a GPU this takes a second, or two if
// nothing is compiled yet.
ScheduleRates measureSchedules(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
