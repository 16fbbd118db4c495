// A pass traces some samples of some pixels to their end. The wavefront:
//
//   generate_rays
//   per bounce:  size_dispatch -> trace_closest -> shade_surface -> size_dispatch -> trace_shadow (where lights are sampled)
//   accumulate, which does nothing while a path is alive
//
// The persistent schedule, in which one kernel traces path after path to its end:
//
//   generate_rays
//   until no path is left:  size_dispatch -> trace_paths
//   accumulate
//
// Nearly always one dispatch of trace_paths suffices: its threads put a path aside only once they have taken as many steps as a dispatch
// may take. No path waits for others, nor for memory between its steps.
//
// Caustics: trace_light_paths, and again after size_dispatch for paths that were too long for one dispatch, for each sample of the picture;
// then add_splats.
//
// AOVs insert show_aov before accumulate. The course's estimators have bounces of their own (course.hpp).
#include "host/render/pass_tracer.hpp"

#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cstddef>

namespace glim {
namespace {

// Bounces recorded at once, after those that earlier passes needed: then the host checks whether any path is alive.
constexpr std::uint32_t kMoreBounces = 8;

}  // namespace

std::optional<PassSeconds> PassTracer::trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue)
{
    Recording recording(resources_.device, resources_.statistics, portion(), shouldContinue);
    if (!traceToEnd(recording, tile, pass, [&] { recordEnd(recording, tile, pass); })) {
        resources_.paths().emptyQueues();
        return std::nullopt;
    }
    if (recording.total() > 0.0) {
        resources_.history.seconds = recording.total();
    }
    return PassSeconds{recording.longest(), recording.total()};
}

void PassTracer::tracePaths(Recording& recording, const Tile& tile, const Pass& pass)
{
    traceToEnd(recording, tile, pass, [] {});
}

std::uint32_t PassTracer::portion() const
{
    return resources_.history.seconds < resources_.settings.uncheckedSeconds ? kMaxTimed : resources_.settings.portion;
}

// Records as many rounds, bounces or dispatches of trace_paths, as may suffice, and the end of the pass, whose kernels do nothing while a
// path is alive. So the host waits once per pass, and rarely again. Returns false if the recording was stopped before the end.
bool PassTracer::traceToEnd(Recording& recording, const Tile& tile, Pass pass, const std::function<void()>& recordEnd)
{
    const bool persistent = kernels().tracePaths.has_value();
    const std::uint32_t last = persistent ? ~0U : pathLengths(resources_.settings).maxBounces;
    std::uint32_t& usual = resources_.history.rounds;
    // generate_rays fills the queue that bounce 0 reads: the next queue of the odd bindings.
    recording.dispatch(*kernels().generateRays, tile.bindings(1), pass, resources_.countGroups(pass.pixelCount * pass.sampleCount));
    resources_.recordSize(recording, tile.bindings(0), pass, persistent ? kSizesShares : kSizesPaths);
    std::uint32_t rounds = usual;
    while (!recording.isStopped() && pass.bounce <= last) {
        for (; rounds > 0 && pass.bounce <= last; --rounds, ++pass.bounce) {
            recordRound(recording, tile.bindings(pass.bounce % 2), pass);
            if (!persistent && pass.bounce == 0 && rounds > 1) {
                recording.start();  // most paths are in bounce 0: the host records the others meanwhile
            }
        }
        recordEnd();
        const bool isWhole = !recording.isStopped();
        recording.finish();
        const QueueSizes sizes = readSizes();
        if (isWhole && sizes.closest == 0) {
            // Of many paths the longest varies by a few surfaces.
            const std::uint32_t needed = sizes.lastBounce + 1;
            usual = std::max(needed + (persistent ? 0 : 2 + needed / 8), usual - 1);
            return true;
        }
        rounds = persistent ? 1 : kMoreBounces;
    }
    return false;
}

// Adds the samples to the film.
void PassTracer::recordEnd(Recording& recording, const Tile& tile, const Pass& pass) const
{
    const Buffer& sizes = resources_.paths().queueSizes();
    recording.keepTogether(3);
    if (kernels().showAov) {  // of rays that end at their first hit
        recording.dispatch(*kernels().showAov, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount * pass.sampleCount));
    }
    recording.dispatchIndirect(*kernels().accumulate, tile.bindings(0), pass, sizes, offsetof(QueueSizes, endGroups));
    resources_.course.recordLuminance(recording, kernels(), tile.bindings(0), pass, sizes);
}

void PassTracer::recordRound(Recording& recording, const Bindings& bindings, const Pass& pass) const
{
    const Buffer& sizes = resources_.paths().queueSizes();
    Pass next = pass;
    next.bounce = pass.bounce + 1;
    if (kernels().tracePaths) {
        recording.dispatchIndirect(*kernels().tracePaths, bindings, pass, sizes, offsetof(QueueSizes, closestGroups));
        resources_.recordSize(recording, bindings, next, kSizesShares);
        return;
    }
    if (usesCourseEstimators(resources_.settings)) {
        resources_.course.recordBounce(recording, kernels(), bindings, pass, sizes);
        resources_.recordSize(recording, bindings, next, kSizesPaths);
        return;
    }
    recording.dispatchIndirect(*kernels().traceClosest, bindings, pass, sizes, offsetof(QueueSizes, closestGroups));
    recording.dispatchIndirect(*kernels().shadeSurface, bindings, pass, sizes, offsetof(QueueSizes, closestGroups));
    const PathLengths lengths = pathLengths(resources_.settings);
    const bool hasShadowRays = samplesLights(pass.bounce, lengths.maxBounces, lengths.min, resources_.lightCount);
    resources_.recordSize(recording, bindings, next, hasShadowRays ? kSizesPaths | kSizesShadow : kSizesPaths);
    if (hasShadowRays) {
        recording.dispatchIndirect(*kernels().traceShadow, bindings, pass, sizes, offsetof(QueueSizes, shadowGroups));
    }
}

std::optional<PassSeconds> PassTracer::traceLight(const SplatBuffer::Band& band, std::uint32_t firstSample, std::uint32_t first,
                                                  std::uint32_t count, const std::function<bool()>& shouldContinue)
{
    Pass pass{};
    pass.tileBegin = band.begin();
    pass.firstPixel = first;
    pass.pixelCount = count;
    pass.firstSample = firstSample;
    pass.sampleCount = 1;
    Recording recording(resources_.device, resources_.statistics, portion(), shouldContinue);
    const std::uint32_t share = resources_.settings.workgroup * rulesOf(resources_.device.description().deviceClass).pathsPerThread;
    // Fills the queue that the next dispatch reads, as generate_rays does.
    recording.dispatch(*kernels().traceLightPaths, band.bindings(1), pass, (count + share - 1) / share);
    pass.bounce = 1;
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = band.bindings(parity);
        resources_.recordSize(recording, bindings, pass, kSizesShares);
        recording.finish();
        alive = !recording.isStopped() && readSizes().closest > 0;
        if (alive) {
            recording.dispatchIndirect(*kernels().traceLightPaths, bindings, pass, resources_.paths().queueSizes(),
                                       offsetof(QueueSizes, closestGroups));
        }
    }
    if (recording.isStopped()) {
        resources_.paths().emptyQueues();
        return std::nullopt;
    }
    return PassSeconds{recording.longest(), recording.total()};
}

void PassTracer::addSplats(const SplatBuffer& splats)
{
    Recording recording(resources_.device, resources_.statistics);
    for (const auto& band : splats.bands()) {
        Pass pass{};
        pass.pixelCount = band->count();
        recording.dispatch(*kernels().addSplats, band->bindings(0), pass, resources_.countGroups(pass.pixelCount));
    }
    recording.finish();
}

void PassTracer::closeBlocks(const Tile& tile)
{
    Pass pass = tile.pass();
    pass.pixelCount = tile.count();
    pass.accumulate = kEndsBlock | kEveryPixel;
    Recording recording(resources_.device, resources_.statistics);
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount));
    recording.finish();
}

std::uint32_t PassTracer::choosePixels(Tile& tile, std::uint32_t samples)
{
    tile.chooseNone();
    CoursePass all{tile.pass(), {}};
    all.pass.pixelCount = tile.count();
    all.pass.firstSample = samples;
    Recording recording(resources_.device, resources_.statistics);
    recording.dispatch(*kernels().course.choosePixels, tile.bindings(0), all, resources_.countGroups(tile.count()));
    recording.finish();
    return tile.readChosenCount();
}

}  // namespace glim
