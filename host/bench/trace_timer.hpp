// Captures rays as kernels make them, and times the kernels that trace them.
#pragma once

#include "host/render/ray_tracer.hpp"

namespace glim {

struct RaySets {
    std::vector<PathRay> primary;   // of the camera
    std::vector<PathRay> diffuse;   // of the first bounce
    std::vector<ShadowRay> shadow;  // from what the camera sees to a light
};

// Rays of the first sample of each of the first `pixels` pixels of the picture, at most pathCapacity.
RaySets captureRays(RenderResources& resources, std::uint32_t pixels);

class TraceTimer {
public:
    // Captures the rays of a picture of at most pathCapacity pixels.
    TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Uses the resources and the rays of `other`, which must outlive it. Only one of the two may trace at a time.
    TraceTimer(const TraceTimer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

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
    double getSeconds(const std::string& kernel) const;

    RenderResources resources_;
    RayTracer tracer_;
    RaySets rays_;
};

}  // namespace glim
