#include "host/bench/trace_timer.hpp"

#include <algorithm>

namespace glim {
namespace {

// Elements of `values` at the first `count` entries of a queue, in the order of slots: the queue's own order depends on which thread came
// first.
template <class T>
std::vector<T> queued(const Buffer& values, const Buffer& queue, std::size_t count, std::size_t slots)
{
    const std::vector<T> all = download<T>(values, slots);
    std::vector<uint> entries = download<uint>(queue, count);
    std::sort(entries.begin(), entries.end());
    std::vector<T> chosen(count);
    std::transform(entries.begin(), entries.end(), chosen.begin(), [&all](uint slot) { return all[slot]; });
    return chosen;
}

// The wavefront has kernels that only trace.
RenderSettings byWavefront(RenderSettings settings)
{
    settings.schedule = Schedule::Wavefront;
    settings.bounces = 1;
    return settings;
}

}  // namespace

RaySets captureRays(Wavefront& wavefront, const Tile& tile)
{
    RaySets sets;
    Pass pass = wavefront.passOf(tile);
    pass.pixelCount = tile.count();
    pass.sampleCount = 1;
    wavefront.watch(tile, pass, [&](const std::string& kernel, const CoursePass& at, PathBuffers& paths) {
        const QueueTails tails = download<QueueTails>(paths.queueTails(), 1)[0];
        if (kernel == "generate_rays") {
            sets.primary = download<PathRay>(paths.rays(), tile.count());
        } else if (kernel == "sample_lights_and_bounce" && at.pass.bounce == 0) {
            sets.shadow = queued<ShadowRay>(paths.shadowRays(), paths.shadowQueue(), tails.shadow, tile.count());
            sets.diffuse = queued<PathRay>(paths.rays(), paths.nextQueue(0), tails.next, tile.count());
        }
    });
    return sets;
}

TraceTimer::TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : wavefront_(device, scene, camera, byWavefront(settings)),
      tile_(wavefront_.makeTile(0, settings.width * settings.height)),
      rays_(captureRays(wavefront_, *tile_))
{}

TraceTimer::TraceTimer(Device& device, TraceTimer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : wavefront_(device, other.wavefront_.shared(), scene, camera, byWavefront(settings)),
      tile_(wavefront_.makeTile(0, settings.width * settings.height)),
      rays_(other.rays_)
{}

// Seconds of the kernel and of its counterpart of the course.
double TraceTimer::secondsOf(const std::string& kernel) const
{
    double seconds = 0.0;
    for (const std::string& name : {kernel, "course_" + kernel}) {
        const auto found = wavefront_.statistics().find(name);
        seconds += found == wavefront_.statistics().end() ? 0.0 : found->second.seconds;
    }
    return seconds;
}

TraceTimer::Closest TraceTimer::trace(std::span<const PathRay> rays)
{
    const double before = secondsOf("trace_closest");
    std::vector<PathHit> hits = wavefront_.traceRays(*tile_, rays);
    return {std::move(hits), secondsOf("trace_closest") - before};
}

TraceTimer::Shadow TraceTimer::trace(std::span<const ShadowRay> rays)
{
    const double before = secondsOf("trace_shadow");
    std::vector<bool> free = wavefront_.traceShadowRays(*tile_, rays);
    return {std::move(free), secondsOf("trace_shadow") - before};
}

}  // namespace glim
