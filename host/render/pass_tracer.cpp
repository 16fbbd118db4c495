// A pass traces some samples of some pixels to their end. The wavefront:
//
//   generate_rays
//   per bounce:  size_dispatch -> trace_closest -> shade_surface -> size_dispatch -> trace_shadow (where lights are sampled)
//   accumulate
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
// Caustics: trace_light_paths, and again after size_dispatch for paths that were too long for one dispatch, for each sample of the picture.
//
// AOVs insert show_aov before accumulate. The course's estimators have bounces of their own (course.hpp).
#include "host/render/pass_tracer.hpp"

#include "shaders/shared/bindings.h"

#include <cstddef>

namespace glim {
namespace {

// Bounces recorded at once; then the host checks whether any path is alive.
constexpr std::uint32_t kBouncesPerCheck = 8;

}  // namespace

std::optional<PassSeconds> PassTracer::trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue)
{
    Recording recording(resources_.device, resources_.statistics, resources_.settings.portion, shouldContinue);
    tracePaths(recording, tile, pass);
    if (recording.isStopped()) {
        resources_.paths().emptyQueues();
        return std::nullopt;
    }
    if (kernels().showAov) {
        recording.dispatch(*kernels().showAov, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount * pass.sampleCount));
    }
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount));
    resources_.course.recordLuminance(recording, kernels(), tile.bindings(0), pass, resources_.countGroups(pass.pixelCount));
    recording.finish();
    return PassSeconds{recording.longest(), recording.total()};
}

void PassTracer::tracePaths(Recording& recording, const Tile& tile, Pass& pass)
{
    // generate_rays fills the queue that bounce 0 reads: the next queue of the odd bindings.
    recording.dispatch(*kernels().generateRays, tile.bindings(1), pass, resources_.countGroups(pass.pixelCount * pass.sampleCount));
    if (kernels().tracePaths) {
        tracePersistently(recording, tile, pass);
    } else {
        traceByWavefront(recording, tile, pass);
    }
}

bool PassTracer::isAnyPathAlive(const Recording& recording) const
{
    return !recording.isStopped() && download<QueueSizes>(resources_.paths().queueSizes(), 1)[0].closest > 0;
}

void PassTracer::traceByWavefront(Recording& recording, const Tile& tile, Pass& pass)
{
    const std::uint32_t maxBounces = pathLengths(resources_.settings).maxBounces;
    resources_.recordSize(recording, tile.bindings(0), pass, kSizesPaths);
    bool alive = true;
    while (alive && pass.bounce <= maxBounces) {
        for (const std::uint32_t end = pass.bounce + kBouncesPerCheck; pass.bounce <= maxBounces && pass.bounce < end; ++pass.bounce) {
            recordBounce(recording, tile.bindings(pass.bounce % 2), pass);
        }
        recording.finish();
        alive = isAnyPathAlive(recording);
    }
}

void PassTracer::recordBounce(Recording& recording, const Bindings& bindings, const Pass& pass) const
{
    const Buffer& sizes = resources_.paths().queueSizes();
    Pass next = pass;
    next.bounce = pass.bounce + 1;
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

void PassTracer::tracePersistently(Recording& recording, const Tile& tile, Pass& pass)
{
    resources_.recordSize(recording, tile.bindings(0), pass, kSizesShares);
    pass.bounce = 1;  // the queue is no longer that of all slots
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = tile.bindings(parity);
        recording.dispatchIndirect(*kernels().tracePaths, bindings, pass, resources_.paths().queueSizes(),
                                   offsetof(QueueSizes, closestGroups));
        resources_.recordSize(recording, bindings, pass, kSizesShares);
        recording.finish();
        alive = isAnyPathAlive(recording);
    }
}

std::optional<PassSeconds> PassTracer::traceLight(const SplatBuffer& splats, std::uint32_t pixel, std::uint32_t firstSample,
                                                  std::uint32_t first, std::uint32_t count, const std::function<bool()>& shouldContinue)
{
    Pass pass{};
    pass.tileBegin = pixel;
    pass.firstPixel = first;
    pass.pixelCount = count;
    pass.firstSample = firstSample;
    pass.sampleCount = 1;
    Recording recording(resources_.device, resources_.statistics, resources_.settings.portion, shouldContinue);
    const std::uint32_t share = resources_.settings.workgroup * rulesOf(resources_.device.description().deviceClass).pathsPerThread;
    // Fills the queue that the next dispatch reads, as generate_rays does.
    recording.dispatch(*kernels().traceLightPaths, splats.bindings(1), pass, (count + share - 1) / share);
    pass.bounce = 1;
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = splats.bindings(parity);
        resources_.recordSize(recording, bindings, pass, kSizesShares);
        recording.finish();
        alive = isAnyPathAlive(recording);
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
