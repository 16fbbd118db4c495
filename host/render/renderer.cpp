// A pass traces some samples of some pixels to their end (wavefront.cpp: the order of the kernels). A sweep is passes over many
// pixels (renderer_sweeps.cpp: which). Which pixels share a pass depends on measured time; the order of a pixel's samples and all
// sums do not.
#include "host/render/renderer.hpp"

#include "host/render/check_status.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <utility>

namespace glim {
namespace {

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
    statistics_.schedule = wavefront_->schedule();
    statistics_.compileSeconds = wavefront_->compileSeconds();
    statistics_.uploadSeconds = secondsSince(start_) - statistics_.compileSeconds;
    begin(camera);
}

std::uint64_t Renderer::nextFoldVersion()
{
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

void Renderer::makeSlabs()
{
    slabs_.clear();
    const std::uint32_t pixels = settings_.width * settings_.height;
    for (std::uint32_t first = 0; first < pixels; first += settings_.slabPixels) {
        slabs_.push_back(wavefront_->makeSlab(first, std::min(settings_.slabPixels, pixels - first)));
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
    mean_ = roundEnd_ = commonEnd_ = 0;
    choosing_ = false;
    if (isNeighbours(settings_.adaptive)) {
        // All pixels together never have more than half of sampleEnd.
        const std::uint32_t half = std::max(kPilotSamples, (settings_.sampleEnd + 1) / 2);
        chosenBlocks_ = BlockQueue(film_.pixels.size(), (half + kBlockSamples - 1) / kBlockSamples * kBlockSamples);
        common_ = film_;
    }
    timesToTarget_ = std::numeric_limits<double>::infinity();
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
    plannedSamples_ = judge ? film_.pixels.size() * leastSamplesForError(settings_.sampleBegin) : plannedSamples_;  // until it is known better
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
    const Slab& slab = *slabs_[pixel / settings_.slabPixels];
    const std::unique_ptr<Slab> copy = wavefront_->makeSlab(pixel, 1);
    copy->copySamples(slab, pixel - slab.begin());
    wavefront_->closeBlocks(*copy);
    return foldMoments(film_.pixels[pixel], copy->takePages().front());
}

// The samples it is of.
void Renderer::describe(Film& film) const
{
    film.sampleRanges = {{settings_.sampleBegin, sweeping_ && !choosing_ ? sweepEnd() : sample_}};
    if (isNeighbours(settings_.adaptive)) {
        if (chosenBlocks_.end() > chosenBlocks_.begin()) {
            film.sampleRanges.emplace_back(chosenBlocks_.begin(), chosenBlocks_.end());
        }
        film.complete = mean_ > 0 && isBetweenRounds();
    } else {
        const bool even = pictureSamples_ > 0 && pictureSamples_ == film.pixels.size() * sampleCount();
        film.complete = isDone() || (even && !isCourse(settings_.adaptive));
    }
    film.seconds = secondsSince(start_);
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
    const bool whole = isNeighbours(settings_.adaptive) ? isBetweenRounds() : sample_ % kBlockSamples == 0;
    const bool ends = !sweeping_ && whole && sampleCount() >= leastSamplesForError(settings_.sampleBegin);
    if (!ends || static_cast<double>(pictureSamples_) < 1.1 * static_cast<double>(judgedSamples_)) {
        return false;
    }
    judgedSamples_ = pictureSamples_;
    timesToTarget_ = std::min(judge(film()), 1e6);
    plannedSamples_ = static_cast<std::uint64_t>(static_cast<double>(pictureSamples_) * std::max(timesToTarget_, 1.0));
    return timesToTarget_ <= 1.0;
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
