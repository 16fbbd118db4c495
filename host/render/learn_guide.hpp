// Learns where light comes from, before the picture, by paths of its own.
#pragma once

#include "host/render/renderer.hpp"

namespace glim {

// What paths of a picture by these settings are guided by: the same on all devices whose pictures have the same bits, and for all samples,
// seeds and rows. Throws DeviceError if the device's driver cannot compile the kernel in reasonable time. Shares the resources of
// `renderer`, a renderer of the scene.
std::shared_ptr<const Guide> learnGuide(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera,
                                        const RenderSettings& settings);
// The same, with resources of its own.
std::shared_ptr<const Guide> learnGuide(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

}  // namespace glim
