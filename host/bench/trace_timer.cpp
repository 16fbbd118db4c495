#include "host/bench/trace_timer.hpp"

#include "host/render/replay.hpp"

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

RaySets captureRays(RenderResources& resources, std::uint32_t pixels)
{
    RaySets sets;
    const std::unique_ptr<Tile> tile = resources.makeTile(0, pixels);
    Pass pass = tile->pass();
    pass.pixelCount = pixels;
    pass.sampleCount = 1;
    watchPass(resources, *tile, pass, [&](const std::string& kernel, const CoursePass& at, PathBuffers& paths) {
        if (kernel == "generate_rays") {
            sets.primary = download<PathRay>(paths.rays(), pixels);
        } else if (kernel == "shade_surface" && at.pass.bounce == 0) {
            const std::vector<Round> rounds = paths.readRounds();
            sets.shadow = queued<ShadowRay>(paths.shadowRays(), paths.shadowQueue(), rounds[at.pass.round].shadowRays.count, pixels);
            sets.diffuse = queued<PathRay>(paths.rays(), paths.nextQueue(0), rounds[at.pass.round + 1].paths.count, pixels);
        }
    });
    for (std::vector<PathRay>* rays : {&sets.primary, &sets.diffuse}) {
        std::ranges::for_each(*rays, [](PathRay& ray) { ray.media = 0; });  // so that none is scattered on its way
    }
    return sets;
}

TraceTimer::TraceTimer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : resources_(device, scene, camera, byWavefront(settings)),
      tracer_(resources_),
      rays_(captureRays(resources_, settings.width * settings.height))
{}

TraceTimer::TraceTimer(const TraceTimer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : resources_(other.resources_, scene, camera, byWavefront(settings)),
      tracer_(resources_),
      rays_(other.rays_)
{}

// Seconds of the kernel and of its counterpart of the course.
double TraceTimer::getSeconds(const std::string& kernel) const
{
    double seconds = 0.0;
    for (const std::string& name : {kernel, "course_" + kernel}) {
        const auto found = resources_.statistics.find(name);
        seconds += found == resources_.statistics.end() ? 0.0 : found->second.seconds;
    }
    return seconds;
}

TraceTimer::Closest TraceTimer::trace(std::span<const PathRay> rays)
{
    const double before = getSeconds("trace_closest");
    std::vector<PathHit> hits = tracer_.trace(rays);
    return {std::move(hits), getSeconds("trace_closest") - before};
}

TraceTimer::Shadow TraceTimer::trace(std::span<const ShadowRay> rays)
{
    const double before = getSeconds("trace_shadow");
    std::vector<bool> free = tracer_.trace(rays);
    return {std::move(free), getSeconds("trace_shadow") - before};
}

}  // namespace glim
