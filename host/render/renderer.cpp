// A pass traces some samples of some pixels to their end (wavefront.cpp: the order of the kernels). A sweep is passes over all
// pixels, or over those that an adaptive render has chosen, for the same few samples of a block. Which pixels share a pass
// depends on measured time; the order of a pixel's samples and all sums do not.
#include "host/render/renderer.hpp"

#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace glim {
namespace {

// Passes aim at this for their longest dispatch: far below any watchdog.
constexpr double kTargetDispatchSeconds = 0.05;
// And at this in all, where many rounds of direct light or long brute force make many dispatches, since --time ends between passes;
// but not if that leaves so little for a dispatch that starting it costs more (with 1 ms for the longest, 512 rounds took three
// times as long as with 10 at 32x32, since those of later bounces have a hundredth of its rays).
constexpr double kTargetPassSeconds = 1.0;
constexpr double kLeastDispatchSeconds = 0.01;
// Of a first pass, with one round of direct light and a ray that takes this many steps.
constexpr std::uint32_t kFirstPassPaths = 1U << 14;
constexpr std::uint64_t kUsualSteps = 64;

std::uint32_t firstPassPaths(const FlatScene& scene, const RenderSettings& settings)
{
    const std::uint64_t records = scene.records.size() / kRecordTexels;
    const std::uint64_t steps = settings.accelerator == Accelerator::None ? std::max(records, kUsualSteps) : kUsualSteps;
    const std::uint64_t work = steps * lightRounds(scene, settings).size();
    return std::clamp(static_cast<std::uint32_t>(kFirstPassPaths * kUsualSteps / work), kBlockSamples, settings.pathCapacity);
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Renderer::Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device), settings_(settings), fingerprint_(fingerprint(scene, camera)), start_(Clock::now()),
      pathsPerPass_(firstPassPaths(scene, settings)),
      plannedSamples_(std::uint64_t{settings.width} * settings.height * (settings.sampleEnd - settings.sampleBegin)),
      wavefront_(std::make_unique<Wavefront>(device, scene, camera, settings))
{
    const std::uint32_t pixels = settings.width * settings.height;
    for (std::uint32_t begin = 0; begin < pixels; begin += Slab::kMaxPixels) {
        slabs_.push_back(wavefront_->makeSlab(begin, std::min(Slab::kMaxPixels, pixels - begin)));
    }
    refuseBrokenStatus();
    statistics_.compileSeconds = wavefront_->compileSeconds();
    statistics_.uploadSeconds = secondsSince(start_) - statistics_.compileSeconds;
}

// End of the sweep that begins with `sample`: the first block is swept 1, 1, 2, 4, 8 and 16 samples at a time, so that a
// render that is stopped early covers its picture evenly; later blocks at once, which keeps the rays of a pixel together.
std::uint32_t Renderer::sweepEnd(std::uint32_t sample) const
{
    const std::uint32_t done = sample - settings_.sampleBegin;
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t end = std::min({settings_.sampleEnd, (sample / kBlockSamples + 1) * kBlockSamples, sample + count});
    return isAdaptive() ? std::min(end, (sample / settings_.batch + 1) * settings_.batch) : end;
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
    std::uint64_t chosen = film.pixels.size();
    bool going = true;
    while (going && chosen > 0 && sample < settings_.sampleEnd) {
        const std::uint32_t end = sweepEnd(sample);
        const bool endsBlock = end == settings_.sampleEnd || end % kBlockSamples == 0;
        going = sweep(sample, end - sample, endsBlock, observer);
        sample = end;
        if (going && isAdaptive() && sample % settings_.batch == 0) {
            chosen = choosePixels();
            plannedSamples_ = statistics_.samples + chosen * (settings_.sampleEnd - sample);
        }
        if (!going || chosen == 0 || sample == settings_.sampleEnd || sample % kPageSamples == 0) {
            foldPages(film, !going || isAdaptive());
        }
    }
    film.sampleRanges = {{settings_.sampleBegin, sample}};
    const bool even = statistics_.samples == film.pixels.size() * (sample - settings_.sampleBegin);
    film.complete = going || (even && !isAdaptive());
    statistics_.renderSeconds = secondsSince(start_);
    film.seconds = statistics_.renderSeconds;
    readCounters();
    return film;
}

// Samples [first, first + count) of every chosen pixel; false if it was ended before the last one, or after it for good.
bool Renderer::sweep(std::uint32_t first, std::uint32_t count, bool endsBlock, const RenderObserver& observer)
{
    for (const auto& slab : slabs_) {
        std::uint32_t pixel = 0;
        while (pixel < slab->chosenCount()) {
            Pass pass = wavefront_->passOf(*slab);
            pass.firstPixel = pixel;
            pass.pixelCount = std::min(slab->chosenCount() - pixel, std::max(1U, pathsPerPass_ / count));
            pass.firstSample = first;
            pass.sampleCount = count;
            pass.accumulate = endsBlock ? kEndsBlock : 0;
            if (!runPass(*slab, pass, observer)) {
                return false;
            }
            pixel += pass.pixelCount;
            if (isOver(observer)) {
                return false;
            }
        }
    }
    return true;
}

// False if the observer ended it before it was done, which it may where a pass is longer than usual.
bool Renderer::runPass(const Slab& slab, const Pass& pass, const RenderObserver& observer)
{
    const Clock::time_point begin = Clock::now();
    const auto traced = wavefront_->trace(
        slab, pass, [&] { return asks(observer) || secondsSince(begin) < kTargetPassSeconds; });
    refuseBrokenStatus();
    if (!traced) {
        return false;
    }
    const Wavefront::Seconds seconds = *traced;
    const std::uint32_t paths = pass.pixelCount * pass.sampleCount;
    statistics_.samples += paths;
    statistics_.longestDispatch = std::max(statistics_.longestDispatch, seconds.longest);
    // What is left at the end of a sweep says little about a full pass, unless it took too long.
    if (seconds.longest > kTargetDispatchSeconds || (seconds.longest > 0.0 && 2 * std::uint64_t{paths} > pathsPerPass_)) {
        resizePasses(paths, seconds);
    }
    return true;
}

void Renderer::resizePasses(std::uint32_t paths, const Wavefront::Seconds& seconds)
{
    const double byPass = std::max(kTargetPassSeconds / seconds.total, kLeastDispatchSeconds / seconds.longest);
    const double scale = std::clamp(std::min(kTargetDispatchSeconds / seconds.longest, byPass), 0.5, 2.0);
    pathsPerPass_ = static_cast<std::uint32_t>(
        std::clamp(paths * scale, static_cast<double>(kBlockSamples), static_cast<double>(settings_.pathCapacity)));
}

// How many pixels still need samples.
std::uint64_t Renderer::choosePixels()
{
    std::uint64_t chosen = 0;
    for (const auto& slab : slabs_) {
        wavefront_->choosePixels(*slab);
        chosen += slab->chosenCount();
    }
    return chosen;
}

// `closesBlocks`: some pixels may have ended within a block.
void Renderer::foldPages(Film& film, bool closesBlocks)
{
    for (const auto& slab : slabs_) {
        if (closesBlocks) {
            wavefront_->closeBlocks(*slab);
        }
        foldPage(film, slab->begin(), slab->takePages());
    }
}

bool Renderer::asks(const RenderObserver& observer)
{
    ended_ = !observer({statistics_.samples, plannedSamples_, secondsSince(start_)}) || ended_;
    return !ended_;
}

bool Renderer::isOver(const RenderObserver& observer)
{
    return !asks(observer) || (settings_.seconds && secondsSince(start_) >= *settings_.seconds);
}

void Renderer::refuseBrokenStatus() const
{
    const Status status = download<Status>(wavefront_->paths().status(), 1)[0];
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
    const RayCounts rays = download<RayCounts>(wavefront_->paths().rayCounts(), 1)[0];
    const Status status = download<Status>(wavefront_->paths().status(), 1)[0];
    statistics_.cameraAndBounceRays = wide(rays.closest);
    statistics_.shadowRays = wide(rays.shadow);
    statistics_.loopCaps = status.loopCaps;
    statistics_.overflows = status.overflows;
    statistics_.nonFinite = status.nonFinite;
    statistics_.located.assign(status.located, status.located + std::min(status.nonFinite, kMaxLocated));
    statistics_.kernels = wavefront_->statistics();
    statistics_.peakDeviceMemory = device_.peakMemory();
}

}  // namespace glim
