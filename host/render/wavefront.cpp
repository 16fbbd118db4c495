// A pass traces some samples of some pixels to their end. The wavefront:
//
//   generate_rays
//   per bounce:  size_dispatch -> trace_closest -> sample_lights_and_bounce -> size_dispatch -> trace_shadow (where lights are sampled)
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
#include "host/render/wavefront.hpp"

#include "host/clock.hpp"
#include "host/error.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>

namespace glim {
namespace {

// Bounces recorded at once; then the host checks whether any path is alive.
constexpr std::uint32_t kBouncesPerCheck = 8;

}  // namespace

Schedule chooseSchedule(const RenderSettings& settings, const DeviceDescription& device)
{
    const bool course = usesCourseEstimators(settings);
    if (settings.schedule == Schedule::Persistent && course) {
        throw InputError(
            "--schedule persistent: the course's estimators (--direct, --roulette, --accelerator, --intersector) need "
            "--schedule wavefront.");
    }
    if (settings.schedule != Schedule::Auto) {
        return settings.schedule;
    }
    const bool known = settings.fastest != Schedule::Auto;
    return !course && (known ? settings.fastest == Schedule::Persistent : device.software) ? Schedule::Persistent : Schedule::Wavefront;
}

Wavefront::Wavefront(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                     LastingResources lasting)
    : device_(device),
      settings_(settings),
      lightCount_(static_cast<std::uint32_t>(scene.lights.size())),
      schedule_(chooseSchedule(settings, device.description())),
      own_(SharedResources{DeviceScene(device, scene, std::move(lasting.buffers)), PathBuffers(device, settings.pathCapacity)}),
      shared_(*own_),
      parameters_(device, scene, camera, settings),
      course_(device, scene, settings),
      compiled_(lasting.kernels && serves(lasting.kernels->set.specialization, specialize(scene, camera, settings))
                    ? std::move(lasting.kernels)
                    : std::make_shared<CompiledKernels>(device, scene, camera, settings, schedule_))
{
    compile();
}

Wavefront::Wavefront(Device& device, SharedResources& shared, const FlatScene& scene, const FlatCamera& camera,
                     const RenderSettings& settings)
    : device_(device),
      settings_(settings),
      lightCount_(static_cast<std::uint32_t>(scene.lights.size())),
      schedule_(chooseSchedule(settings, device.description())),
      shared_(shared),
      parameters_(device, scene, camera, settings),
      course_(device, scene, settings),
      compiled_(std::make_shared<CompiledKernels>(device, scene, camera, settings, schedule_))
{
    compile();
}

void Wavefront::adapt(const FlatScene& scene, const FlatCamera& camera)
{
    const Specialization needed = specialize(scene, camera, settings_);
    if (serves(kernels().specialization, needed)) {
        return;
    }
    std::swap(compiled_, spare_);
    if (!compiled_ || !serves(kernels().specialization, needed)) {
        compiled_ = std::make_shared<CompiledKernels>(device_, scene, camera, settings_, schedule_);
        compile();
    }
}

void Wavefront::setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    parameters_.setCamera(camera, width, height);
}

void Wavefront::clearStatistics()
{
    statistics_.clear();
    shared_.paths.clearCounters();
}

BufferMap Wavefront::constants() const
{
    BufferMap constants = shared_.scene.buffers();
    constants.insert({{kBindParameters, &parameters_.buffer()}, {kBindCourseParameters, &course_.parameters()}});
    return constants;
}

std::unique_ptr<Tile> Wavefront::makeTile(std::uint32_t begin, std::uint32_t count)
{
    return std::make_unique<Tile>(device_, compiled_->layout, constants(), shared_.paths, begin, count, settings_);
}

std::unique_ptr<SplatBuffer> Wavefront::makeSplatBuffer(std::uint32_t count)
{
    return std::make_unique<SplatBuffer>(device_, compiled_->layout, constants(), shared_.paths, count);
}

// llvmpipe compiles a kernel at its first dispatch. This one has nothing to do, so that no timed dispatch pays for that.
void Wavefront::compile()
{
    const auto start = Clock::now();
    const std::unique_ptr<Tile> tile = makeTile(0, 1);
    const std::unique_ptr<SplatBuffer> splats = makeSplatBuffer(1);
    CoursePass nothing{passOf(*tile), {}};
    nothing.pass.bounce = 1;
    nothing.pass.sizes = kSizesPaths | kSizesShadow;
    Commands commands(device_);
    for (const Kernel* kernel : kernels().all()) {
        const bool light = kernels().traceLightPaths && kernel == &*kernels().traceLightPaths;
        commands.dispatch(*kernel, light ? splats->bindings(0) : tile->bindings(0),
                          std::as_bytes(std::span<const CoursePass, 1>(&nothing, 1)), 1);
    }
    commands.submitAndWait();
    compileSeconds_ = secondsSince(start);
}

Pass Wavefront::passOf(const Tile& tile) const
{
    Pass pass{};
    pass.tileBegin = tile.begin();
    return pass;
}

std::uint32_t Wavefront::groupsOf(std::uint32_t count) const { return (count + settings_.workgroup - 1) / settings_.workgroup; }

std::optional<PassSeconds> Wavefront::trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue)
{
    Recording recording(device_, statistics_, settings_.portion, shouldContinue);
    tracePaths(recording, tile, pass);
    if (recording.isStopped()) {
        shared_.paths.emptyQueues();
        return std::nullopt;
    }
    if (kernels().showAov) {
        recording.dispatch(*kernels().showAov, tile.bindings(0), pass, groupsOf(pass.pixelCount * pass.sampleCount));
    }
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, groupsOf(pass.pixelCount));
    course_.recordLuminance(recording, kernels(), tile.bindings(0), pass, groupsOf(pass.pixelCount));
    recording.finish();
    return PassSeconds{recording.longest(), recording.total()};
}

void Wavefront::tracePaths(Recording& recording, const Tile& tile, Pass& pass)
{
    // generate_rays fills the queue that bounce 0 reads: the next queue of the odd bindings.
    recording.dispatch(*kernels().generateRays, tile.bindings(1), pass, groupsOf(pass.pixelCount * pass.sampleCount));
    if (kernels().tracePaths) {
        tracePersistently(recording, tile, pass);
    } else {
        traceByWavefront(recording, tile, pass);
    }
}

bool Wavefront::isAnyPathAlive(const Recording& recording) const
{
    return !recording.isStopped() && download<QueueSizes>(shared_.paths.queueSizes(), 1)[0].closest > 0;
}

void Wavefront::traceByWavefront(Recording& recording, const Tile& tile, Pass& pass)
{
    const std::uint32_t maxBounces = pathLengths(settings_).maxBounces;
    recordSize(recording, tile.bindings(0), pass, kSizesPaths);
    bool alive = true;
    while (alive && pass.bounce <= maxBounces) {
        for (const std::uint32_t end = pass.bounce + kBouncesPerCheck; pass.bounce <= maxBounces && pass.bounce < end; ++pass.bounce) {
            recordBounce(recording, tile.bindings(pass.bounce % 2), pass);
        }
        recording.finish();
        alive = isAnyPathAlive(recording);
    }
}

void Wavefront::recordBounce(Recording& recording, const Bindings& bindings, const Pass& pass) const
{
    const Buffer& sizes = shared_.paths.queueSizes();
    Pass next = pass;
    next.bounce = pass.bounce + 1;
    if (usesCourseEstimators(settings_)) {
        course_.recordBounce(recording, kernels(), bindings, pass, sizes);
        recordSize(recording, bindings, next, kSizesPaths);
        return;
    }
    recording.dispatchIndirect(*kernels().traceClosest, bindings, pass, sizes, offsetof(QueueSizes, closestGroups));
    recording.dispatchIndirect(*kernels().sampleLightsAndBounce, bindings, pass, sizes, offsetof(QueueSizes, closestGroups));
    const PathLengths lengths = pathLengths(settings_);
    const bool hasShadowRays = samplesLights(pass.bounce, lengths.maxBounces, lengths.min, lightCount_);
    recordSize(recording, bindings, next, hasShadowRays ? kSizesPaths | kSizesShadow : kSizesPaths);
    if (hasShadowRays) {
        recording.dispatchIndirect(*kernels().traceShadow, bindings, pass, sizes, offsetof(QueueSizes, shadowGroups));
    }
}

void Wavefront::recordSize(Recording& recording, const Bindings& bindings, Pass pass, std::uint32_t queues) const
{
    pass.sizes = queues;
    recording.dispatch(*kernels().sizeDispatch, bindings, pass, 1);
}

void Wavefront::recordTrace(Recording& recording, const std::optional<Kernel>& production, const std::optional<Kernel>& course,
                            const Bindings& bindings, const Pass& pass, std::uint64_t groupsOffset) const
{
    if (usesCourseEstimators(settings_)) {
        CoursePass round{pass, {}};
        round.lightRound.lightSamples = 1;
        course_.recordTrace(recording, course.value(), bindings, round, shared_.paths.queueSizes(), groupsOffset);
    } else {
        recording.dispatchIndirect(production.value(), bindings, pass, shared_.paths.queueSizes(), groupsOffset);
    }
}

void Wavefront::tracePersistently(Recording& recording, const Tile& tile, Pass& pass)
{
    recordSize(recording, tile.bindings(0), pass, kSizesShares);
    pass.bounce = 1;  // the queue is no longer that of all slots
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = tile.bindings(parity);
        recording.dispatchIndirect(*kernels().tracePaths, bindings, pass, shared_.paths.queueSizes(), offsetof(QueueSizes, closestGroups));
        recordSize(recording, bindings, pass, kSizesShares);
        recording.finish();
        alive = isAnyPathAlive(recording);
    }
}

std::optional<PassSeconds> Wavefront::traceLight(const SplatBuffer& splats, std::uint32_t pixel, std::uint32_t firstSample,
                                                 std::uint32_t first, std::uint32_t count, const std::function<bool()>& shouldContinue)
{
    Pass pass{};
    pass.tileBegin = pixel;
    pass.firstPixel = first;
    pass.pixelCount = count;
    pass.firstSample = firstSample;
    pass.sampleCount = 1;
    Recording recording(device_, statistics_, settings_.portion, shouldContinue);
    const std::uint32_t share = settings_.workgroup * kPathsPerThread;
    // Fills the queue that the next dispatch reads, as generate_rays does.
    recording.dispatch(*kernels().traceLightPaths, splats.bindings(1), pass, (count + share - 1) / share);
    pass.bounce = 1;
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = splats.bindings(parity);
        recordSize(recording, bindings, pass, kSizesShares);
        recording.finish();
        alive = isAnyPathAlive(recording);
        if (alive) {
            recording.dispatchIndirect(*kernels().traceLightPaths, bindings, pass, shared_.paths.queueSizes(),
                                       offsetof(QueueSizes, closestGroups));
        }
    }
    if (recording.isStopped()) {
        shared_.paths.emptyQueues();
        return std::nullopt;
    }
    return PassSeconds{recording.longest(), recording.total()};
}

PathRadiance Wavefront::traceSample(std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch)
{
    const std::unique_ptr<Tile> tile = makeTile(pixel, 1);
    Pass pass = passOf(*tile);
    pass.pixelCount = pass.sampleCount = 1;
    pass.firstSample = sample;
    this->watch(*tile, pass, watch);
    return shared_.paths.takeRadiance();
}

void Wavefront::watch(const Tile& tile, Pass pass, const PathWatch& watch)
{
    Recording::Watch watchKernel;
    if (watch) {
        watchKernel = [&](const Kernel& kernel, std::span<const std::byte> push) {
            CoursePass dispatched{};
            std::memcpy(&dispatched, push.data(), push.size());
            watch(kernel.name(), dispatched, shared_.paths);
        };
    }
    Recording recording(device_, statistics_, watchKernel);
    tracePaths(recording, tile, pass);
    recording.finish();
}

std::vector<PathHit> Wavefront::traceRays(const Tile& tile, std::span<const PathRay> rays)
{
    shared_.paths.queueRays(rays);
    Pass pass = passOf(tile);
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    Recording recording(device_, statistics_);
    recordSize(recording, tile.bindings(0), pass, kSizesPaths);
    recordTrace(recording, kernels().traceClosest, kernels().course.traceClosest, tile.bindings(0), pass,
                offsetof(QueueSizes, closestGroups));
    recording.finish();
    return download<PathHit>(shared_.paths.hits(), rays.size());
}

std::vector<bool> Wavefront::traceShadowRays(const Tile& tile, std::span<const ShadowRay> rays)
{
    shared_.paths.queueShadowRays(rays);
    Pass pass = passOf(tile);
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    Recording recording(device_, statistics_);
    recordSize(recording, tile.bindings(0), pass, kSizesShadow);
    recordTrace(recording, kernels().traceShadow, kernels().course.traceShadow, tile.bindings(0), pass, offsetof(QueueSizes, shadowGroups));
    recording.finish();
    const std::vector<PathRadiance> found = download<PathRadiance>(shared_.paths.radiance(), rays.size());
    std::vector<bool> free(rays.size());
    std::transform(found.begin(), found.end(), free.begin(), [](const PathRadiance& each) { return each.radiance.r > 0.0F; });
    return free;
}

void Wavefront::closeBlocks(const Tile& tile)
{
    Pass pass = passOf(tile);
    pass.pixelCount = tile.count();
    pass.accumulate = kEndsBlock | kEveryPixel;
    Recording recording(device_, statistics_);
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, groupsOf(pass.pixelCount));
    recording.finish();
}

void Wavefront::choosePixels(Tile& tile, std::uint32_t samples)
{
    tile.chooseNone();
    CoursePass all{passOf(tile), {}};
    all.pass.pixelCount = tile.count();
    all.pass.firstSample = samples;
    Recording recording(device_, statistics_);
    recording.dispatch(*kernels().course.choosePixels, tile.bindings(0), all, groupsOf(tile.count()));
    recording.finish();
    tile.readChosenCount();
}

}  // namespace glim
