// A pass traces some samples of some pixels to their end:
//
//   generate_rays
//   per bounce:  size_dispatch -> trace_closest -> sample_lights -> bounce -> size_dispatch' -> trace_shadow
//   accumulate
//
// (size_dispatch' is also the size_dispatch of the next bounce.) A sweep is passes over all pixels for the same few samples
// of a block. Which pixels share a pass depends on measured time; the order of a pixel's samples and all sums do not.
#include "host/render/renderer.hpp"

#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace glim {
namespace {

// Passes aim at this for their longest dispatch: far below any watchdog, and Ctrl-C is answered at once.
constexpr double kTargetDispatchSeconds = 0.05;
constexpr std::uint32_t kFirstPassPaths = 1U << 14;
// Bounces recorded at once; then the host looks whether any path is alive.
constexpr std::uint32_t kBouncesPerSubmission = 8;

std::span<const std::byte> bytesOf(const Pass& pass) { return std::as_bytes(std::span<const Pass, 1>(&pass, 1)); }

Specialization specialize(const SceneFeatures& features, const RenderSettings& settings)
{
    return {{kSpecWorkgroup, settings.workgroup},
            {kSpecSpheres, features.spheres},
            {kSpecSmooth, features.smooth},
            {kSpecSpecular, features.specular},
            {kSpecSurfaceLights, features.surfaceLights},
            {kSpecPunctualLights, features.punctualLights},
            {kSpecEnvironment, features.environment},
            {kSpecSobol, settings.sampler == Sampler::Sobol},
            {kSpecMollerTrumbore, settings.intersector == Intersector::MollerTrumbore}};
}

Pass passTemplate(const FlatScene& scene, const RenderSettings& settings)
{
    Pass pass{};
    pass.width = settings.width;
    pass.height = settings.height;
    pass.seed = settings.seed;
    pass.maxBounces = settings.bounces;
    pass.lightCount = static_cast<std::uint32_t>(scene.lights.size());
    pass.environment = scene.environment;
    pass.environmentLight = scene.environmentLight;
    pass.clampIndirect = settings.clampIndirect;
    pass.canarySteps = 3;
    return pass;
}

// End of the sweep that begins with `sample`: the first block is swept 1, 1, 2, 4, 8 and 16 samples at a time, so that a
// render that is stopped early covers its picture evenly; later blocks at once, which keeps the rays of a pixel together.
std::uint32_t sweepEnd(std::uint32_t sample, const RenderSettings& settings)
{
    const std::uint32_t done = sample - settings.sampleBegin;
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    return std::min({settings.sampleEnd, (sample / kBlockSamples + 1) * kBlockSamples, sample + count});
}

std::uint32_t groupsOf(std::uint32_t count, std::uint32_t workgroup) { return (count + workgroup - 1) / workgroup; }

}  // namespace

Kernel Renderer::kernel(const EmbeddedShader& shader) const { return Kernel(layout_, shader, specialization_); }

Renderer::Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device), settings_(settings), specialization_(specialize(scene.features, settings)),
      template_(passTemplate(scene, settings)), fingerprint_(fingerprint(scene, camera)), start_(Clock::now()),
      pathsPerPass_(std::min(kFirstPassPaths, settings.pathCapacity)),
      scene_(device, scene, camera), paths_(device, settings.pathCapacity), layout_(device, kernelSlots(), sizeof(Pass)),
      generateRays_(kernel(kernels::generate_rays)), sizeDispatch_(kernel(kernels::size_dispatch)),
      traceClosest_(kernel(kernels::trace_closest)), sampleLights_(kernel(kernels::sample_lights)),
      traceShadow_(kernel(kernels::trace_shadow)), bounce_(kernel(kernels::bounce)),
      accumulate_(kernel(kernels::accumulate))
{
    const std::uint32_t pixels = settings.width * settings.height;
    Commands commands(device);
    for (std::uint32_t begin = 0; begin < pixels; begin += Slab::kMaxPixels) {
        slabs_.push_back(std::make_unique<Slab>(device, layout_, scene_, paths_, begin,
                                                std::min(Slab::kMaxPixels, pixels - begin)));
        commands.fillWithZero(slabs_.back()->blocks());
        commands.fillWithZero(slabs_.back()->pages());
    }
    commands.submitAndWait();
    const Clock::time_point uploaded = Clock::now();
    compile();
    statistics_.uploadSeconds = std::chrono::duration<double>(uploaded - start_).count();
    statistics_.compileSeconds = std::chrono::duration<double>(Clock::now() - uploaded).count();
}

// llvmpipe compiles at the first dispatch: one with nothing to do, so that no timed one pays.
void Renderer::compile()
{
    const Slab& slab = *slabs_[0];
    Pass pass = passOf(slab);
    pass.bounce = 1;
    Commands commands(device_);
    for (const Kernel* each : {&sizeDispatch_, &generateRays_, &traceClosest_, &sampleLights_, &traceShadow_, &bounce_,
                               &accumulate_}) {
        commands.dispatch(*each, slab.bindings(0), bytesOf(pass), 1);
    }
    commands.submitAndWait();
    refuseBrokenStatus();
}

Pass Renderer::passOf(const Slab& slab) const
{
    Pass pass = template_;
    pass.slabBegin = slab.begin();
    return pass;
}

Film Renderer::render(const RenderObserver& observer)
{
    Film film;
    film.width = settings_.width;
    film.height = settings_.height;
    film.pixels.resize(std::size_t{film.width} * film.height);
    film.identity = {fingerprint_, describeSettings(settings_), settings_.seed};
    film.device = device_.description().name + ", " + device_.description().driver;

    start_ = Clock::now();
    std::uint32_t sample = settings_.sampleBegin;
    bool going = true;
    while (going && sample < settings_.sampleEnd) {
        const std::uint32_t end = sweepEnd(sample, settings_);
        const bool endsBlock = end == settings_.sampleEnd || end % kBlockSamples == 0;
        going = sweep(sample, end - sample, endsBlock, observer);
        sample = end;
        if (!going) {
            closeBlocks();
        }
        if (!going || sample % kPageSamples == 0 || sample == settings_.sampleEnd) {
            foldPages(film);
        }
    }
    film.sampleRanges = {{settings_.sampleBegin, sample}};
    film.complete = statistics_.samples == film.pixels.size() * (sample - settings_.sampleBegin);
    statistics_.renderSeconds = std::chrono::duration<double>(Clock::now() - start_).count();
    film.seconds = statistics_.renderSeconds;
    readCounters();
    return film;
}

// Samples [first, first + count) of every pixel; false if it was ended before the last one, or after it for good.
bool Renderer::sweep(std::uint32_t first, std::uint32_t count, bool endsBlock, const RenderObserver& observer)
{
    for (const auto& slab : slabs_) {
        std::uint32_t pixel = 0;
        while (pixel < slab->count()) {
            Pass pass = passOf(*slab);
            pass.firstPixel = pixel;
            pass.pixelCount = std::min(slab->count() - pixel, std::max(1U, pathsPerPass_ / count));
            pass.firstSample = first;
            pass.sampleCount = count;
            pass.accumulate = endsBlock ? kEndsBlock : 0;
            runPass(*slab, pass);
            pixel += pass.pixelCount;
            if (isOver(observer)) {
                return false;
            }
        }
    }
    return true;
}

void Renderer::runPass(const Slab& slab, Pass pass)
{
    tracePaths(slab, pass);
    Commands commands(device_);
    commands.dispatch(accumulate_, slab.bindings(0), bytesOf(pass), groupsOf(pass.pixelCount, settings_.workgroup));
    run(commands);
    refuseBrokenStatus();
    statistics_.samples += std::uint64_t{pass.pixelCount} * pass.sampleCount;
}

void Renderer::tracePaths(const Slab& slab, Pass& pass)
{
    const std::uint32_t paths = pass.pixelCount * pass.sampleCount;
    double longest = 0.0;
    bool alive = true;
    for (std::uint32_t bounce = 0; alive && bounce <= settings_.bounces; bounce += kBouncesPerSubmission) {
        Commands commands(device_);
        if (bounce == 0) {
            // generate_rays fills what bounce 0 reads: its next queue is the odd bindings' one.
            commands.dispatch(generateRays_, slab.bindings(1), bytesOf(pass), groupsOf(paths, settings_.workgroup));
        }
        const std::uint32_t end = std::min(settings_.bounces, bounce + kBouncesPerSubmission - 1);
        for (pass.bounce = bounce; pass.bounce <= end; ++pass.bounce) {
            recordBounce(commands, slab, pass);
        }
        run(commands);
        for (const KernelTime& time : commands.times()) {
            longest = std::max(longest, time.seconds);
        }
        alive = download<QueueSizes>(paths_.queueSizes(), 1)[0].closest > 0;
    }
    statistics_.longestDispatch = std::max(statistics_.longestDispatch, longest);
    if (longest > 0.0) {
        const double scale = std::clamp(kTargetDispatchSeconds / longest, 0.5, 2.0);
        pathsPerPass_ = static_cast<std::uint32_t>(
            std::clamp(paths * scale, static_cast<double>(kBlockSamples), static_cast<double>(settings_.pathCapacity)));
    }
}

void Renderer::recordBounce(Commands& commands, const Slab& slab, const Pass& pass) const
{
    const Bindings& bindings = slab.bindings(pass.bounce % 2);
    const Buffer& sizes = paths_.queueSizes();
    if (pass.bounce == 0) {
        commands.dispatch(sizeDispatch_, bindings, bytesOf(pass), 1);
    }
    commands.dispatchIndirect(traceClosest_, bindings, bytesOf(pass), sizes, offsetof(QueueSizes, closestGroups));
    commands.dispatchIndirect(sampleLights_, bindings, bytesOf(pass), sizes, offsetof(QueueSizes, closestGroups));
    commands.dispatchIndirect(bounce_, bindings, bytesOf(pass), sizes, offsetof(QueueSizes, closestGroups));
    Pass next = pass;
    next.bounce = pass.bounce + 1;
    commands.dispatch(sizeDispatch_, bindings, bytesOf(next), 1);
    commands.dispatchIndirect(traceShadow_, bindings, bytesOf(pass), sizes, offsetof(QueueSizes, shadowGroups));
}

void Renderer::run(Commands& commands)
{
    commands.submitAndWait();
    for (const KernelTime& time : commands.times()) {
        KernelStatistics& kernel = statistics_.kernels[time.kernel];
        ++kernel.dispatches;
        kernel.seconds += time.seconds;
    }
}

// After an early end: folds the blocks that are under way into their pages.
void Renderer::closeBlocks()
{
    for (const auto& slab : slabs_) {
        Pass pass = passOf(*slab);
        pass.pixelCount = slab->count();
        pass.accumulate = kEndsBlock;
        Commands commands(device_);
        commands.dispatch(accumulate_, slab->bindings(0), bytesOf(pass), groupsOf(pass.pixelCount, settings_.workgroup));
        run(commands);
    }
}

void Renderer::foldPages(Film& film)
{
    for (const auto& slab : slabs_) {
        foldPage(film, slab->begin(), download<PixelMoments>(slab->pages(), slab->count()));
        Commands commands(device_);
        commands.fillWithZero(slab->pages());
        commands.submitAndWait();
    }
}

bool Renderer::isOver(const RenderObserver& observer) const
{
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const std::uint64_t pixels = std::uint64_t{settings_.width} * settings_.height;
    const bool stop = !observer({statistics_.samples, pixels * (settings_.sampleEnd - settings_.sampleBegin), seconds});
    return stop || (settings_.seconds && seconds >= *settings_.seconds);
}

void Renderer::refuseBrokenStatus() const
{
    const Status status = download<Status>(paths_.status(), 1)[0];
    if (status.loopCaps > 0) {
        throw DeviceError("The driver of \"" + device_.description().name + "\" cut loops short in " +
                          std::to_string(status.loopCaps) +
                          " threads (their budget of iterations is spent), so the picture would be wrong; "
                          "the scene's BVH takes more steps per ray than this driver allows (Mesa's software driver has no such "
                          "budget from version 24 on).");
    }
    if (status.overflows > 0) {
        throw DeviceError("Queues on \"" + device_.description().name + "\" are " + std::to_string(status.overflows) +
                          " entries longer than there are paths, so the picture would be wrong.");
    }
}

void Renderer::readCounters()
{
    const auto wide = [](uvec2 words) { return std::uint64_t{words.y} << 32 | words.x; };
    const RayCounts rays = download<RayCounts>(paths_.rayCounts(), 1)[0];
    const Status status = download<Status>(paths_.status(), 1)[0];
    statistics_.cameraAndBounceRays = wide(rays.closest);
    statistics_.shadowRays = wide(rays.shadow);
    statistics_.loopCaps = status.loopCaps;
    statistics_.overflows = status.overflows;
    statistics_.nonFinite = status.nonFinite;
    statistics_.located.assign(status.located, status.located + std::min(status.nonFinite, kMaxLocated));
    statistics_.peakDeviceMemory = device_.peakMemory();
}

}  // namespace glim
