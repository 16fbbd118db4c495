// A pass traces some samples of some pixels to their end:
//
//   generate_rays
//   per bounce:  size_dispatch -> trace_closest
//                per round of direct light:  sample_lights -> size_dispatch -> trace_shadow
//                bounce
//   accumulate
//
// A round over the hemisphere has sample_hemisphere and trace_hemisphere instead. --view puts show_view before accumulate. Brute
// force repeats each trace_ for the next records. In the persistent schedule, trace_paths alone stands for all bounces
// (wavefront_persistent.cpp).
#include "host/render/wavefront.hpp"

#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace glim {
namespace {

// Bounces recorded at once; then the host looks whether any path is alive.
constexpr std::uint32_t kBouncesPerLook = 8;

Pass passTemplate(const FlatScene& scene, const RenderSettings& settings)
{
    Pass pass{};
    pass.width = settings.width;
    pass.height = settings.height;
    pass.seed = settings.seed;
    pass.lightCount = static_cast<std::uint32_t>(scene.lights.size());
    pass.environment = scene.environment;
    pass.environmentLight = scene.environmentLight;
    pass.clampIndirect = settings.clampIndirect;
    pass.canarySteps = 3;
    pass.leastEvents = settings.paths == PathParts::Direct ? 1 : settings.paths == PathParts::Indirect ? 2 : 0;
    pass.mostEvents = settings.paths == PathParts::Emission ? 0 : settings.paths == PathParts::Direct ? 1 : settings.bounces;
    pass.maxBounces = settings.view == View::Shaded ? std::min(settings.bounces, pass.mostEvents) : 0;
    pass.survival = settings.survival;
    pass.recordCount = static_cast<std::uint32_t>(scene.records.size()) / kRecordTexels;
    pass.endRecord = pass.recordCount;
    pass.tolerance = settings.tolerance;
    pass.constantSamples = settings.adaptive == Adaptive::CourseLiteral ? 0 : kConstantSamples;
    return pass;
}

}  // namespace

Wavefront::Wavefront(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device), settings_(settings), rounds_(lightRounds(scene, settings)),
      schedule_(chooseSchedule(settings, rounds_.size(), device.description())), template_(passTemplate(scene, settings)),
      ownScene_(std::in_place, device, scene), ownPaths_(std::in_place, device, settings.pathCapacity), scene_(*ownScene_),
      paths_(*ownPaths_), camera_(device, camera), layout_(device, kernelSlots(), sizeof(Pass)),
      kernels_(layout_, specialize(scene.features, camera, settings), schedule_)
{
    compile();
}

Wavefront::Wavefront(Wavefront& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(lender.device_), settings_(settings), rounds_(lightRounds(scene, settings)),
      schedule_(chooseSchedule(settings, rounds_.size(), device_.description())), template_(passTemplate(scene, settings)),
      scene_(lender.scene_), paths_(lender.paths_), camera_(device_, camera), layout_(device_, kernelSlots(), sizeof(Pass)),
      kernels_(layout_, specialize(scene.features, camera, settings), schedule_)
{
    compile();
}

void Wavefront::setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    camera_.set(camera);
    template_.width = width;
    template_.height = height;
}

std::unique_ptr<Slab> Wavefront::makeSlab(std::uint32_t begin, std::uint32_t count)
{
    return std::make_unique<Slab>(device_, layout_, scene_, camera_, paths_, begin, count, settings_);
}

// llvmpipe compiles at the first dispatch: one with nothing to do, so that no timed one pays.
void Wavefront::compile()
{
    const auto start = std::chrono::steady_clock::now();
    const std::unique_ptr<Slab> slab = makeSlab(0, 1);
    Pass pass = passOf(*slab);
    pass.bounce = 1;
    pass.sizes = kSizesPaths | kSizesShadow;
    Commands commands(device_);
    for (const Kernel* kernel : kernels_.all()) {
        commands.dispatch(*kernel, slab->bindings(0), std::as_bytes(std::span<const Pass, 1>(&pass, 1)), 1);
    }
    commands.submitAndWait();
    compileSeconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Pass Wavefront::passOf(const Slab& slab) const
{
    Pass pass = template_;
    pass.slabBegin = slab.begin();
    return pass;
}

std::uint32_t Wavefront::groupsOf(std::uint32_t count) const
{
    return (count + settings_.workgroup - 1) / settings_.workgroup;
}

std::optional<PassSeconds> Wavefront::trace(const Slab& slab, Pass pass, const std::function<bool()>& goesOn)
{
    Recording recording(device_, statistics_, settings_.portion, goesOn);
    tracePaths(recording, slab, pass);
    if (recording.isStopped()) {
        paths_.emptyQueues();
        return std::nullopt;
    }
    if (kernels_.showView) {
        recording.dispatch(*kernels_.showView, slab.bindings(0), pass, groupsOf(pass.pixelCount * pass.sampleCount));
    }
    recording.dispatch(*kernels_.accumulate, slab.bindings(0), pass, groupsOf(pass.pixelCount));
    recording.finish();
    return PassSeconds{recording.longest(), recording.total()};
}

void Wavefront::tracePaths(Recording& recording, const Slab& slab, Pass& pass)
{
    if (kernels_.tracePaths) {
        tracePersistently(recording, slab, pass);
        return;
    }
    bool alive = true;
    for (std::uint32_t bounce = 0; alive && bounce <= pass.maxBounces; bounce += kBouncesPerLook) {
        if (bounce == 0) {
            // generate_rays fills what bounce 0 reads: its next queue is the odd bindings' one.
            recording.dispatch(*kernels_.generateRays, slab.bindings(1), pass, groupsOf(pass.pixelCount * pass.sampleCount));
        }
        const std::uint32_t end = std::min(pass.maxBounces, bounce + kBouncesPerLook - 1);
        for (pass.bounce = bounce; pass.bounce <= end; ++pass.bounce) {
            recordBounce(recording, slab, pass);
        }
        recording.finish();
        alive = !recording.isStopped() && download<QueueSizes>(paths_.queueSizes(), 1)[0].closest > 0;
    }
}

void Wavefront::recordBounce(Recording& recording, const Slab& slab, const Pass& pass) const
{
    const Bindings& bindings = slab.bindings(pass.bounce % 2);
    if (pass.bounce == 0) {
        recordSize(recording, bindings, pass, kSizesPaths);
    }
    recordTrace(recording, *kernels_.traceClosest, bindings, pass, offsetof(QueueSizes, closestGroups));
    recordRounds(recording, bindings, pass);
    recording.dispatchIndirect(*kernels_.bounce, bindings, pass, paths_.queueSizes(), offsetof(QueueSizes, closestGroups));
    Pass next = pass;
    next.bounce = pass.bounce + 1;
    recordSize(recording, bindings, next, kSizesPaths);
}

void Wavefront::recordRounds(Recording& recording, const Bindings& bindings, const Pass& pass) const
{
    // Light sampled here has met one surface more than the path; the last hit only finds light.
    const bool counts = pass.bounce < pass.maxBounces && pass.bounce + 1 >= pass.leastEvents;
    const std::vector<LightRound> finding = {{false, kNoLightIndex}};
    Pass round = pass;
    round.addsFound = 1;
    for (const LightRound& each : counts ? rounds_ : finding) {
        round.light = each.light;
        round.lightSample = each.sample;
        round.lightSamples = each.samples;
        recordRound(recording, bindings, round, each.hemisphere);
        round.addsFound = 0;
    }
}

void Wavefront::recordRound(Recording& recording, const Bindings& bindings, const Pass& round, bool hemisphere) const
{
    const Kernel& sample = hemisphere ? *kernels_.sampleHemisphere : *kernels_.sampleLights;
    recording.dispatchIndirect(sample, bindings, round, paths_.queueSizes(), offsetof(QueueSizes, closestGroups));
    if (hemisphere || round.light != kNoLightIndex) {
        recordSize(recording, bindings, round, kSizesShadow);
        recordTrace(recording, hemisphere ? *kernels_.traceHemisphere : *kernels_.traceShadow, bindings, round,
                    offsetof(QueueSizes, shadowGroups));
    }
}

void Wavefront::recordSize(Recording& recording, const Bindings& bindings, Pass pass, std::uint32_t queues) const
{
    pass.sizes = queues;
    recording.dispatch(*kernels_.sizeDispatch, bindings, pass, 1);
}

void Wavefront::recordTrace(Recording& recording, const Kernel& kernel, const Bindings& bindings, Pass pass,
                            std::uint64_t groupsOffset) const
{
    const bool bruteForce = settings_.accelerator == Accelerator::None;
    const std::uint32_t step = bruteForce ? kScanRecords : pass.recordCount;
    for (pass.firstRecord = 0; pass.firstRecord < pass.recordCount; pass.firstRecord += step) {
        pass.endRecord = std::min(pass.recordCount, pass.firstRecord + step);
        recording.dispatchIndirect(kernel, bindings, pass, paths_.queueSizes(), groupsOffset);
    }
}

PathRadiance Wavefront::traceSample(std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch)
{
    const std::unique_ptr<Slab> slab = makeSlab(pixel, 1);
    Pass pass = passOf(*slab);
    pass.pixelCount = pass.sampleCount = 1;
    pass.firstSample = sample;
    this->watch(*slab, pass, watch);
    return paths_.takeRadiance();
}

void Wavefront::watch(const Slab& slab, Pass pass, const PathWatch& watch)
{
    std::function<void(const Kernel&, const Pass&)> watchKernel;
    if (watch) {
        watchKernel = [&](const Kernel& kernel, const Pass& dispatched) { watch(kernel.name(), dispatched, paths_); };
    }
    Recording recording(device_, statistics_, watchKernel);
    tracePaths(recording, slab, pass);
}

std::vector<PathHit> Wavefront::traceRays(const Slab& slab, std::span<const PathRay> rays)
{
    paths_.queueRays(rays);
    Pass pass = passOf(slab);
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    Recording recording(device_, statistics_);
    recordSize(recording, slab.bindings(0), pass, kSizesPaths);
    recordTrace(recording, kernels_.traceClosest.value(), slab.bindings(0), pass, offsetof(QueueSizes, closestGroups));
    recording.finish();
    return download<PathHit>(paths_.hits(), rays.size());
}

std::vector<bool> Wavefront::traceShadowRays(const Slab& slab, std::span<const ShadowRay> rays)
{
    paths_.queueShadowRays(rays);
    Pass pass = passOf(slab);
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    pass.leastEvents = 0;
    pass.mostEvents = 1;
    Recording recording(device_, statistics_);
    recordSize(recording, slab.bindings(0), pass, kSizesShadow);
    recordTrace(recording, kernels_.traceShadow.value(), slab.bindings(0), pass, offsetof(QueueSizes, shadowGroups));
    recording.finish();
    const std::vector<PathRadiance> found = download<PathRadiance>(paths_.radiance(), rays.size());
    std::vector<bool> free(rays.size());
    std::transform(found.begin(), found.end(), free.begin(), [](const PathRadiance& each) { return each.radiance.r > 0.0F; });
    return free;
}

void Wavefront::closeBlocks(const Slab& slab)
{
    Pass pass = passOf(slab);
    pass.pixelCount = slab.count();
    pass.accumulate = kEndsBlock | kEveryPixel;
    Recording recording(device_, statistics_);
    recording.dispatch(*kernels_.accumulate, slab.bindings(0), pass, groupsOf(pass.pixelCount));
    recording.finish();
}

void Wavefront::choosePixels(Slab& slab)
{
    slab.chooseNone();
    Pass pass = passOf(slab);
    pass.pixelCount = slab.count();
    Recording recording(device_, statistics_);
    recording.dispatch(*kernels_.choosePixels, slab.bindings(0), pass, groupsOf(pass.pixelCount));
    recording.finish();
    slab.readChosenCount();
}

}  // namespace glim
