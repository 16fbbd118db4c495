// How fast the kernels that trace rays are on a device, in each variant, and their share of a picture's time.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/gpu/device.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/scene_types.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace glim {

struct Spread {
    double median, low, high;
};

// `values`: at least one.
Spread computeSpread(std::vector<double> values);

struct KernelRate {
    std::string rays;     // primary, diffuse, shadow
    std::string variant;  // as rendered: the one that renders use
    std::size_t count;    // of rays
    Spread rate;          // rays per second of device time, over rounds
    double ofBest;        // median, relative to the fastest variant's for these rays
};

// Traces three kinds of rays, at most one per pixel: camera rays, those of the first bounce, and shadow rays of the first vertex.
// Every variant traces them in turn, in each of kRateRounds rounds. Kinds without rays in this scene are absent. Empty if
// `shouldContinue`, asked before each round, ended it.
std::vector<KernelRate> measureKernelRates(Device& device, FlatScene scene, const FlatCamera& camera, const RenderSettings& settings,
                                           const std::function<bool(int round)>& shouldContinue);

inline constexpr int kRateRounds = 9;

struct PictureRate {
    Schedule schedule;              // that rendered it
    std::uint64_t samples;          // over all pixels
    std::uint64_t closest, shadow;  // rays of each kind
    Spread seconds;                 // of rendering, over renders
    double traceSeconds;            // median; of the wavefront's kernels that only trace, for the same rays

    double traceShare() const { return traceSeconds / seconds.median; }
};

inline constexpr int kPictureRenders = 5;
inline constexpr std::uint32_t kPictureSamples = 8;  // a pixel

// Nothing if `shouldContinue`, asked before each render, ended it.
std::optional<PictureRate> measurePictureRate(Device& device, const FlatScene& scene, const FlatCamera& camera,
                                              const RenderSettings& settings, const std::function<bool(int round)>& shouldContinue);

}  // namespace glim
