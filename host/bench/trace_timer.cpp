#include "host/bench/trace_timer.hpp"

namespace glim {
namespace {

// Whose kernels trace and do nothing else.
RenderSettings byWavefront(RenderSettings settings)
{
    settings.schedule = Schedule::Wavefront;
    return settings;
}

}  // namespace

TraceTimer::TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : wavefront_(device, scene, camera, byWavefront(settings)), slab_(wavefront_.makeSlab(0, settings.width * settings.height)),
      rays_(captureRays(wavefront_, *slab_))
{
}

TraceTimer::TraceTimer(TraceTimer& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : wavefront_(lender.wavefront_, scene, camera, byWavefront(settings)), slab_(wavefront_.makeSlab(0, settings.width * settings.height)),
      rays_(lender.rays_)
{
}

double TraceTimer::secondsOf(const char* kernel) const
{
    const auto found = wavefront_.statistics().find(kernel);
    return found == wavefront_.statistics().end() ? 0.0 : found->second.seconds;
}

TraceTimer::Closest TraceTimer::trace(std::span<const PathRay> rays)
{
    const double before = secondsOf("trace_closest");
    std::vector<PathHit> hits = wavefront_.traceRays(*slab_, rays);
    return {std::move(hits), secondsOf("trace_closest") - before};
}

TraceTimer::Shadow TraceTimer::trace(std::span<const ShadowRay> rays)
{
    const double before = secondsOf("trace_shadow");
    std::vector<bool> free = wavefront_.traceShadowRays(*slab_, rays);
    return {std::move(free), secondsOf("trace_shadow") - before};
}

}  // namespace glim
