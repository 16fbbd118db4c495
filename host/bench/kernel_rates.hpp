// How fast the kernels that trace rays are on a device, in the variants that there are.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/device.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/scene_types.h"

#include <functional>
#include <string>
#include <vector>

namespace glim {

struct Spread {
    double median, low, high;
};

// `values`: at least one.
Spread spreadOf(std::vector<double> values);

struct KernelRate {
    std::string rays;     // primary, diffuse, shadow
    std::string variant;  // as rendered: the one that renders use
    std::size_t count;    // of rays
    Spread rate;          // rays per second of the device's own time, over rounds
    double ofBest;        // median over the fastest variant's of these rays
};

// Rays of the camera, of the first bounce, and from what the camera sees to a light, one a pixel at most, traced in each of kRateRounds
// rounds by every variant in turn. Kinds that the scene has no ray of are absent. Empty if `goesOn`, asked before each round, ended it.
std::vector<KernelRate> measureKernelRates(Device& device, FlatScene scene, const FlatCamera& camera, const RenderSettings& settings,
                                           const std::function<bool(int round)>& goesOn);

inline constexpr int kRateRounds = 9;

}  // namespace glim
