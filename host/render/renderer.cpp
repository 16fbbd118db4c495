// A pass traces some samples of some pixels to their end (wavefront.cpp: the order of the kernels). A sweep is passes over all
// pixels, or over those that an adaptive render has chosen, for the same few samples of a block. Which pixels share a pass
// depends on measured time; the order of a pixel's samples and all sums do not.
#include "host/render/renderer.hpp"

#include "host/render/check_status.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <utility>

namespace glim {
namespace {

// Of all renderers together: what one has folded is never taken for what another has.
std::uint64_t nextVersion()
{
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Renderer::Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device), settings_(settings), sceneFingerprint_(fingerprint(scene)), start_(Clock::now()),
      passSize_(scene, settings), wavefront_(std::make_unique<Wavefront>(device, scene, camera, settings))
{
    open(camera);
}

Renderer::Renderer(const Renderer& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(lender.device_), settings_(settings), sceneFingerprint_(lender.sceneFingerprint_), start_(Clock::now()),
      passSize_(scene, settings), wavefront_(std::make_unique<Wavefront>(*lender.wavefront_, scene, camera, settings))
{
    open(camera);
}

void Renderer::open(const FlatCamera& camera)
{
    makeSlabs();
    refuseBrokenStatus(device_.description(), wavefront_->paths());
    statistics_.compileSeconds = wavefront_->compileSeconds();
    statistics_.uploadSeconds = secondsSince(start_) - statistics_.compileSeconds;
    begin(camera);
}

void Renderer::makeSlabs()
{
    slabs_.clear();
    const std::uint32_t pixels = settings_.width * settings_.height;
    for (std::uint32_t first = 0; first < pixels; first += Slab::kMaxPixels) {
        slabs_.push_back(wavefront_->makeSlab(first, std::min(Slab::kMaxPixels, pixels - first)));
    }
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    const glm::uvec2 before(settings_.width, settings_.height), size(width, height);
    settings_.width = width;
    settings_.height = height;
    wavefront_->setCamera(camera, width, height);
    if (size != before) {
        std::swap(slabs_, spare_);
        if (size != std::exchange(spareSize_, before)) {
            makeSlabs();
        }
    }
    for (const auto& slab : slabs_) {
        slab->clear();
    }
    begin(camera);
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t seed)
{
    settings_.seed = seed;
    wavefront_->setSeed(seed);
    restart(camera, settings_.width, settings_.height);
}

void Renderer::begin(const FlatCamera& camera)
{
    film_ = {};
    film_.width = settings_.width;
    film_.height = settings_.height;
    film_.pixels.resize(std::size_t{film_.width} * film_.height);
    film_.identity = {fingerprint(sceneFingerprint_, camera), describeSettings(settings_), settings_.seed};
    film_.device = device_.description().name + ", " + device_.description().driver;
    foldVersion_ = 0;
    sample_ = settings_.sampleBegin;
    sweeping_ = false;
    slab_ = 0;
    pixel_ = 0;
    chosen_ = film_.pixels.size();
    pictureSamples_ = judgedSamples_ = 0;
    plannedSamples_ = chosen_ * (settings_.sampleEnd - settings_.sampleBegin);
    start_ = Clock::now();
}

Film Renderer::render(const RenderObserver& observer, const FilmJudge& judge)
{
    start_ = Clock::now();
    plannedSamples_ = judge ? film_.pixels.size() * 2 * kBlockSamples : plannedSamples_;  // until it is known better
    Clock::time_point begin = start_;
    const auto goesOn = [&] { return asks(observer) || secondsSince(begin) < settings_.passSeconds; };
    while (advance(goesOn) && !isOver(observer) && !(judge && isGoodEnough(judge))) {
        begin = Clock::now();
    }
    foldPages(film_, slabs_);
    statistics_.renderSeconds = secondsSince(start_);
    readCounters();
    describe(film_);
    return std::move(film_);
}

Film Renderer::film()
{
    Film film = film_;
    std::vector<std::unique_ptr<Slab>> copies;
    for (const auto& slab : slabs_) {
        copies.push_back(wavefront_->makeSlab(slab->begin(), slab->count()));
        copies.back()->copySamples(*slab, 0);
    }
    foldPages(film, copies);
    readCounters();
    describe(film);
    return film;
}

PixelMoments Renderer::moments(std::uint32_t pixel)
{
    const Slab& slab = *slabs_[pixel / Slab::kMaxPixels];
    const std::unique_ptr<Slab> copy = wavefront_->makeSlab(pixel, 1);
    copy->copySamples(slab, pixel - slab.begin());
    wavefront_->closeBlocks(*copy);
    return foldMoments(film_.pixels[pixel], copy->takePages().front());
}

// The samples it is of.
void Renderer::describe(Film& film) const
{
    film.sampleRanges = {{settings_.sampleBegin, sweeping_ ? sweepEnd() : sample_}};
    const bool even = pictureSamples_ > 0 && pictureSamples_ == film.pixels.size() * sampleCount();
    film.complete = isDone() || (even && !isAdaptive());
    film.seconds = secondsSince(start_);
}

// End of the sweep under way: the first block is swept 1, 1, 2, 4, 8 and 16 samples at a time, so that a render that is stopped
// early covers its picture evenly; later blocks at once, which keeps the rays of a pixel together.
std::uint32_t Renderer::sweepEnd() const
{
    const std::uint32_t done = sampleCount();
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t end = std::min({settings_.sampleEnd, (sample_ / kBlockSamples + 1) * kBlockSamples, sample_ + count});
    return isAdaptive() ? std::min(end, (sample_ / settings_.batch + 1) * settings_.batch) : end;
}

bool Renderer::advance(const std::function<bool()>& goesOn)
{
    if (isDone() || !runPass(nextPass(), goesOn)) {
        return false;
    }
    while (slab_ < slabs_.size() && pixel_ == slabs_[slab_]->chosenCount()) {
        ++slab_;
        pixel_ = 0;
    }
    if (slab_ == slabs_.size()) {
        endSweep();
    }
    return true;
}

Pass Renderer::nextPass() const
{
    const Slab& slab = *slabs_[slab_];
    const std::uint32_t end = sweepEnd();
    Pass pass = wavefront_->passOf(slab);
    pass.firstPixel = pixel_;
    pass.firstSample = sample_;
    pass.sampleCount = end - sample_;
    pass.pixelCount = std::min(slab.chosenCount() - pixel_, std::max(1U, passSize_.paths() / pass.sampleCount));
    pass.accumulate = end % kBlockSamples == 0 ? kEndsBlock : 0;
    return pass;
}

// False if `goesOn` ended it before it was done.
bool Renderer::runPass(const Pass& pass, const std::function<bool()>& goesOn)
{
    const auto traced = wavefront_->trace(*slabs_[slab_], pass, goesOn);
    refuseBrokenStatus(device_.description(), wavefront_->paths());
    if (!traced) {
        return false;
    }
    const PassSeconds seconds = *traced;
    const std::uint32_t paths = pass.pixelCount * pass.sampleCount;
    sweeping_ = true;
    pixel_ += pass.pixelCount;
    pictureSamples_ += paths;
    statistics_.samples += paths;
    statistics_.passSeconds += seconds.total;
    statistics_.longestDispatch = std::max(statistics_.longestDispatch, seconds.longest);
    passSize_.learn(paths, seconds);
    return true;
}

void Renderer::endSweep()
{
    sample_ = sweepEnd();
    sweeping_ = false;
    slab_ = 0;
    if (isAdaptive() && sample_ % settings_.batch == 0) {
        chosen_ = choosePixels();
        plannedSamples_ = pictureSamples_ + chosen_ * (settings_.sampleEnd - sample_);
    }
    while (chosen_ > 0 && slabs_[slab_]->chosenCount() == 0) {
        ++slab_;
    }
    if (sample_ % kPageSamples == 0) {
        foldPages(film_, slabs_);
        foldVersion_ = nextVersion();
    }
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

// Ends the blocks under way, which in adaptive renders and at the end may be any.
void Renderer::foldPages(Film& film, const std::vector<std::unique_ptr<Slab>>& slabs)
{
    for (const auto& slab : slabs) {
        wavefront_->closeBlocks(*slab);
        foldPage(film, slab->begin(), slab->takePages());
    }
}

bool Renderer::asks(const RenderObserver& observer)
{
    ended_ = !observer({pictureSamples_, plannedSamples_, secondsSince(start_)}) || ended_;
    return !ended_;
}

bool Renderer::isOver(const RenderObserver& observer)
{
    return !asks(observer) || (settings_.seconds && secondsSince(start_) >= *settings_.seconds);
}

// Looks whenever blocks end, but not before there are a tenth more samples: looking often would stop where the estimate happens
// to be low, and takes time.
bool Renderer::isGoodEnough(const FilmJudge& judge)
{
    const bool ends = !sweeping_ && sample_ % kBlockSamples == 0 && sampleCount() >= 2 * kBlockSamples;
    if (!ends || static_cast<double>(pictureSamples_) < 1.1 * static_cast<double>(judgedSamples_)) {
        return false;
    }
    judgedSamples_ = pictureSamples_;
    const double times = std::min(judge(film()), 1e6);
    plannedSamples_ = static_cast<std::uint64_t>(static_cast<double>(pictureSamples_) * std::max(times, 1.0));
    return times <= 1.0;
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
