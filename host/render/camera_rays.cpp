#include "host/render/camera_rays.hpp"

#include "host/render/check_status.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"

#include <cstddef>

namespace glim {
namespace {

// Neighbours: passes go over lists of pixels.
RenderSettings settingsOfRays(RenderSettings settings)
{
    settings.adaptive = Adaptive::Neighbours;
    settings.aov = Aov::Radiance;
    settings.bounces = 0;
    settings.suspects = 0;
    settings.course = {};
    return settings;
}

}  // namespace

CameraRays::CameraRays(Device& device, SharedResources& shared, const FlatScene& scene, const FlatCamera& camera,
                       const RenderSettings& settings)
    : device_(device),
      settings_(settingsOfRays(settings)),
      paths_(shared.paths),
      scene_(shared.scene),
      passSize_(scene, settings_),
      parameters_(device, scene, camera, settings_),
      chosen_(device, "chosen pixels", BufferKind::Storage, sizeof(uint) + settings_.pathCapacity * sizeof(ChosenPixel)),
      layout_(device, kernelSlots(), sizeof(Pass)),
      generateRays_(layout_, kernels::generate_rays, specialize(scene, camera, settings_)),
      sizeDispatch_(layout_, kernels::size_dispatch, specialize(scene, camera, settings_)),
      traceClosest_(layout_, kernels::trace_closest, specialize(scene, camera, settings_)),
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
    return Bindings(layout_, buffers);
}

// As Wavefront::compile.
void CameraRays::compile()
{
    choose({});
    Pass nothing{};
    nothing.bounce = 1;
    nothing.sizes = kSizesPaths;
    Commands commands(device_);
    for (const Kernel* kernel : {&sizeDispatch_, &generateRays_, &traceClosest_}) {
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
    pass.sizes = kSizesPaths;
    const std::uint32_t rays = pass.pixelCount * sampleCount;
    std::map<std::string, KernelStatistics> statistics;
    Recording recording(device_, statistics);
    recording.dispatch(generateRays_, odd_, pass, (rays + settings_.workgroup - 1) / settings_.workgroup);
    recording.dispatch(sizeDispatch_, even_, pass, 1);
    recording.dispatchIndirect(traceClosest_, even_, pass, paths_.queueSizes(), offsetof(QueueSizes, closestGroups));
    recording.finish();
    refuseBrokenStatus(device_.description(), paths_);
    passSize_.learn(rays, {recording.longest(), recording.total()});
    return download<PathHit>(paths_.hits(), rays);
}

}  // namespace glim
