// Learns where light comes from, before the picture, by paths of its own.
#pragma once

#include "host/render/renderer.hpp"

#include <functional>

namespace glim {

// Called between the dispatches of learning, and before a guide is built: then `needsDevice` is false, and whoever is asked may use the
// device until the next call. False ends the learning.
using LearningPause = std::function<bool(bool needsDevice)>;

// What paths of a picture by these settings are guided by: the same on all devices whose pictures have the same bits, and for all samples,
// seeds and rows. Throws DeviceError if the device's driver cannot compile the kernel in reasonable time. Shares the resources of
// `renderer`, a renderer of the scene. Null if `pause` has ended it.
std::shared_ptr<const Guide> learnGuide(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera,
                                        const RenderSettings& settings, const LearningPause& pause = nullptr);
// The same, with resources of its own.
std::shared_ptr<const Guide> learnGuide(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
