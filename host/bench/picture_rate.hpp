// How much of a picture's time its rays take.
#pragma once

#include "host/bench/kernel_rates.hpp"

#include <optional>

namespace glim {

struct PictureRate {
    Schedule schedule;              // that rendered it
    std::uint64_t samples;          // over all pixels
    std::uint64_t closest, shadow;  // rays of each kind
    Spread seconds;                 // of rendering, over renders
    double traceSeconds;            // of the wavefront's kernels that trace the same rays and do nothing else; median

    double traceShare() const { return traceSeconds / seconds.median; }
};

inline constexpr int kPictureRenders = 5;
inline constexpr std::uint32_t kPictureSamples = 8;  // a pixel

// Nothing if `goesOn`, asked before each render, ended it.
std::optional<PictureRate> measurePictureRate(Device& device, const FlatScene& scene, const FlatCamera& camera,
                                              const RenderSettings& settings, const std::function<bool(int round)>& goesOn);

}  // namespace glim
