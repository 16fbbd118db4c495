// Which schedule is the faster one on a device.
#pragma once

#include "host/render/renderer.hpp"

namespace glim {

// Seconds of the picture once more, all of it, from the same random numbers.
double timeRender(Renderer& renderer, const FlatCamera& camera);

// False where one of them cannot render what is asked for, or was asked for by name.
bool canMeasureSchedules(const FlatScene& scene, const RenderSettings& settings);

// Samples per second.
struct ScheduleRates {
    double wavefront, persistent;

    Schedule fastest() const { return persistent > wavefront ? Schedule::Persistent : Schedule::Wavefront; }
};

// Of the scene, the two in turn; both must be able to. On two cores without a GPU: a second, or two if nothing is compiled yet.
ScheduleRates measureSchedules(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
