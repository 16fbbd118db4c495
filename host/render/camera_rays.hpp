// Traces camera rays without shading: those of a picture's samples again, or one through the centre of each pixel.
#pragma once

#include "host/render/pass_size.hpp"
#include "host/render/render_resources.hpp"

namespace glim {

enum class RayPlace { Samples, Centers };

struct CameraRayKernels {
    CameraRayKernels(Device& device, const Specialization& constants, RayPlace rayPlace);

    Specialization specialization;
    RayPlace place;
    KernelLayout layout;
    Kernel generateRays, traceClosest;
};

class CameraRays {
public:
    // `settings`: the picture's. Uses the resources of its renderer, which must outlive this and be idle while rays are traced. Compiles
    // its kernels unless `kernels` serve the scene too.
    CameraRays(Device& device, SharedResources& shared, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
               std::shared_ptr<const CameraRayKernels> kernels = nullptr, RayPlace place = RayPlace::Samples);

    std::shared_ptr<const CameraRayKernels> kernels() const { return kernels_; }

    // How many rays a trace should have at most: fewer where they take long.
    std::uint32_t rayCount() const { return passSize_.paths(); }
    // What samples [firstSample, firstSample + sampleCount) of each pixel see first, one pixel after the other. As in the picture, a
    // sample passes surfaces with alpha by chance. Through centres there is one ray, with the random numbers of firstSample. Throws
    // DeviceError as Renderer::render does.
    std::vector<PathHit> trace(std::span<const std::uint32_t> pixels, std::uint32_t firstSample, std::uint32_t sampleCount);
    // The rays of the last trace.
    std::vector<PathRay> rays(std::size_t count) const { return download<PathRay>(paths_.rays(), count); }
    // What these meet first, each with the random numbers of its pixel. As many rays as pixels, at most rayCount().
    std::vector<PathHit> trace(std::span<const std::uint32_t> pixels, std::span<const PathRay> rays);

private:
    std::uint32_t countGroups(std::uint32_t rays) const { return (rays + settings_.workgroup - 1) / settings_.workgroup; }
    Bindings bind(std::uint32_t parity) const;
    void compile();
    void choose(std::span<const std::uint32_t> pixels);
    std::vector<PathHit> trace(const Pass& pass, bool areQueued);

    Device& device_;
    RenderSettings settings_;
    PathBuffers& paths_;
    const DeviceScene& scene_;
    PassSize passSize_;
    DeviceParameters parameters_;
    Buffer chosen_;  // as a Tile's
    std::shared_ptr<const CameraRayKernels> kernels_;
    Bindings even_, odd_;
};

}  // namespace glim
