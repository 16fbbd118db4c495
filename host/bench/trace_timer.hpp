// Times the kernels that trace rays.
#pragma once

#include "host/bench/ray_sets.hpp"

namespace glim {

class TraceTimer {
public:
    // Of the scene's rays as the camera has them: as many pixels as `settings` have, which is pathCapacity at most.
    TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // In the buffers of `lender`, which must outlive it, with its rays; one of the two traces at a time.
    TraceTimer(TraceTimer& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    const RaySets& rays() const { return rays_; }

    // What the rays meet, and device seconds.
    struct Closest {
        std::vector<PathHit> hits;
        double seconds;
    };
    Closest trace(std::span<const PathRay> rays);
    struct Shadow {
        std::vector<bool> free;
        double seconds;
    };
    Shadow trace(std::span<const ShadowRay> rays);

private:
    double secondsOf(const char* kernel) const;

    Wavefront wavefront_;
    std::unique_ptr<Slab> slab_;
    RaySets rays_;
};

}  // namespace glim
