// Captures rays as kernels make them, and times the kernels that trace them.
#pragma once

#include "host/render/wavefront.hpp"

namespace glim {

struct RaySets {
    std::vector<PathRay> primary;   // of the camera
    std::vector<PathRay> diffuse;   // of the first bounce
    std::vector<ShadowRay> shadow;  // from what the camera sees to a light
};

// Rays of the first sample of every pixel of the tile. The tile has at most pathCapacity pixels.
RaySets captureRays(Wavefront& wavefront, const Tile& tile);

class TraceTimer {
public:
    // Captures the rays of a picture of at most pathCapacity pixels.
    TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Uses the resources and the rays of `other`, which must outlive it. Only one of the two may trace at a time.
    TraceTimer(Device& device, TraceTimer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    const RaySets& rays() const { return rays_; }

    // The hits of the rays, and device seconds.
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
    double secondsOf(const std::string& kernel) const;

    Wavefront wavefront_;
    std::unique_ptr<Tile> tile_;
    RaySets rays_;
};

}  // namespace glim
