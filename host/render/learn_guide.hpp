// Learns where light comes from, before the picture, by paths of its own.
#pragma once

#include "host/render/learned_guide.hpp"
#include "host/render/renderer.hpp"

#include <functional>

namespace glim {

// A pause of learning, several a second.
struct LearningPause {
    double done;       // of it, in [0, 1]; it may end sooner
    bool needsDevice;  // else a guide is built next, and whoever is asked may use the device until the next pause
};

// False ends the learning.
using LearningObserver = std::function<bool(const LearningPause&)>;

enum class GuideUse { Always, IfItPays };

// What paths of a picture by these settings are guided by: the same on all devices whose pictures have the same bits, and for all samples,
// seeds and rows. Throws DeviceError if the device's driver cannot compile the kernel in reasonable time. Shares the resources of
// `renderer`, a renderer of the scene.
LearnedGuide learnGuide(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                        GuideUse use, const LearningObserver& observer);
// The same, with resources of its own.
LearnedGuide learnGuide(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                        GuideUse use = GuideUse::Always);

}  // namespace glim
