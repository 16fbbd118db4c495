#include "host/render/camera_rays.hpp"

#include "host/render/check_status.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <cstddef>
#include <utility>

namespace glim {
namespace {

// Neighbours: passes go over lists of pixels.
RenderSettings makeRaySettings(RenderSettings settings)
{
    settings.adaptive = Adaptive::Neighbours;
    settings.aov = Aov::Radiance;
    settings.bounces = 0;
    settings.suspects = 0;
    settings.course = {};
    return settings;
}

// A ray ends at the first surface, wherever the camera stands: it is not scattered before.
Specialization specializeRays(const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings, const Device& device)
{
    Specialization constants = specialize(scene, camera, settings, device.description());
    constants[kSpecUpperFeatures] &= ~static_cast<std::uint32_t>(kFeatureScattering >> 32U);
    return constants;
}

}  // namespace

CameraRayKernels::CameraRayKernels(Device& device, const Specialization& constants, RayPlace rayPlace)
    : specialization(constants),
      place(rayPlace),
      layout(device, kernelSlots(), sizeof(Pass)),
      generateRays(layout, place == RayPlace::Samples ? kernels::generate_rays : kernels::generate_center_rays, constants),
      traceClosest(layout, kernels::trace_closest, constants)
{}

CameraRays::CameraRays(Device& device, SharedResources& shared, const FlatScene& scene, const FlatCamera& camera,
                       const RenderSettings& settings, std::shared_ptr<const CameraRayKernels> kernels, RayPlace place)
    : device_(device),
      settings_(makeRaySettings(settings)),
      paths_(shared.paths),
      scene_(shared.scene),
      passSize_(scene, settings_, paths_.capacity()),
      parameters_(device, scene, camera, settings_, place == RayPlace::Centers ? std::optional(scene.frameTime) : std::nullopt),
      chosen_(device, "chosen pixels", BufferKind::Storage, sizeof(uint) + paths_.capacity() * sizeof(ChosenPixel)),
      kernels_(kernels && kernels->place == place && serves(kernels->specialization, specializeRays(scene, camera, settings_, device))
                   ? std::move(kernels)
                   : std::make_shared<CameraRayKernels>(device, specializeRays(scene, camera, settings_, device), place)),
      even_(bind(0)),
      odd_(bind(1))
{
    compile();
}

Bindings CameraRays::bind(std::uint32_t parity) const
{
    BufferMap buffers = scene_.buffers();
    buffers.merge(paths_.buffers(parity));
    buffers.insert({{kBindParameters, &parameters_.buffer()}, {kBindChosenPixels, &chosen_}});
    return Bindings(kernels_->layout, buffers);
}

// As RenderResources::compile.
void CameraRays::compile()
{
    choose({});
    Pass nothing{};
    paths_.setRounds(makeRounds(0, 0));
    Commands commands(device_);
    for (const Kernel* kernel : {&kernels_->generateRays, &kernels_->traceClosest}) {
        commands.dispatch(*kernel, even_, std::as_bytes(std::span<const Pass, 1>(&nothing, 1)), 1);
    }
    commands.submitAndWait();
}

void CameraRays::choose(std::span<const std::uint32_t> pixels)
{
    std::vector<uint> list{static_cast<uint>(pixels.size())};
    for (const std::uint32_t pixel : pixels) {
        const ChosenPixel chosen{pixel, 0};
        list.insert(list.end(), {chosen.pixel, chosen.samplesBefore});
    }
    upload(chosen_, std::span<const uint>(list));
}

std::vector<PathHit> CameraRays::trace(std::span<const std::uint32_t> pixels, std::uint32_t firstSample, std::uint32_t sampleCount)
{
    choose(pixels);
    Pass pass{};
    pass.pixelCount = static_cast<std::uint32_t>(pixels.size());
    pass.firstSample = firstSample;
    pass.sampleCount = sampleCount;
    const std::uint32_t rays = pass.pixelCount * sampleCount;
    paths_.setRounds(makeRounds(rays, countGroups(rays)));
    return trace(pass, false);
}

std::vector<PathHit> CameraRays::trace(std::span<const std::uint32_t> pixels, std::span<const PathRay> rays)
{
    choose(pixels);
    Pass pass{};
    pass.pixelCount = static_cast<std::uint32_t>(pixels.size());
    pass.sampleCount = 1;
    paths_.queueRays(rays, countGroups(pass.pixelCount));
    return trace(pass, true);
}

std::vector<PathHit> CameraRays::trace(const Pass& pass, bool areQueued)
{
    const std::uint32_t rays = pass.pixelCount * pass.sampleCount, groups = countGroups(rays);
    std::map<std::string, KernelStatistics> statistics;
    Recording recording(device_, statistics);
    if (!areQueued) {
        recording.dispatch(kernels_->generateRays, odd_, pass, groups);
    }
    recording.dispatch(kernels_->traceClosest, even_, pass, groups);
    recording.finish();
    refuseBrokenStatus(device_.description(), paths_);
    passSize_.learn(rays, {recording.longest(), recording.total()});
    return download<PathHit>(paths_.hits(), rays);
}

}  // namespace glim
