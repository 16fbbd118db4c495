// A pass traces some samples of some pixels to their end (wavefront.cpp: the order of the kernels). A sweep is the passes that give all
// pixels, or those that an adaptive render has chosen, the same number of samples. --adaptive neighbours works in rounds: sweeps over all
// pixels, then sweeps over chosen ones. These take blocks of samples beyond those that all pixels will ever have.
//
// Which pixels share a pass depends on measured time. The order of a pixel's samples and all sums do not.
#include "host/render/renderer.hpp"

#include "host/render/check_status.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <utility>

namespace glim {
namespace {

// Whether a uniform render with a target judges its error after the samples from `begin` to `end`: at ends of blocks, at least a tenth
// apart. Judging more often would stop where the estimate happens to be low, and takes time.
bool isJudgedAt(std::uint32_t begin, std::uint32_t end)
{
    std::uint32_t judged = 0, sample = begin;
    while (sample < end) {
        sample = blockEnd(sample);
        const std::uint32_t count = sample - begin;
        if (count >= leastSamplesForError(begin) && count >= 1.1 * judged) {
            judged = count;
        }
    }
    return sample == end && judged == end - begin && judged > 0;
}

}  // namespace

Renderer::Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device),
      settings_(settings),
      sceneIdentity_(scene),
      start_(Clock::now()),
      passSize_(scene, settings),
      wavefront_(std::make_unique<Wavefront>(device, scene, camera, settings))
{
    open(scene, camera);
}

Renderer::Renderer(const Renderer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(other.device_),
      settings_(settings),
      sceneIdentity_(other.sceneIdentity_),
      start_(Clock::now()),
      passSize_(scene, settings),
      wavefront_(std::make_unique<Wavefront>(device_, other.wavefront_->shared(), scene, camera, settings))
{
    open(scene, camera);
}

void Renderer::open(const FlatScene& scene, const FlatCamera& camera)
{
    if (tracesLight(scene, settings_)) {
        light_.emplace(scene, settings_);
    }
    makeTiles();
    refuseBrokenStatus(device_.description(), wavefront_->paths());
    statistics_.schedule = wavefront_->schedule();
    statistics_.compileSeconds = wavefront_->compileSeconds();
    statistics_.uploadSeconds = secondsSinceStart() - statistics_.compileSeconds;
    begin(camera);
}

std::uint64_t Renderer::nextFoldVersion()
{
    static std::atomic<std::uint64_t> last = 0;
    return ++last;
}

void Renderer::makeTiles()
{
    tiles_.clear();
    const std::uint32_t end = settings_.firstPixel() + settings_.pixelCount();
    for (std::uint32_t first = settings_.firstPixel(); first < end; first += settings_.tilePixels) {
        tiles_.push_back(wavefront_->makeTile(first, std::min(settings_.tilePixels, end - first)));
    }
}

void Renderer::setSampling(const RenderSettings& settings)
{
    settings_.sampleBegin = settings.sampleBegin;
    settings_.sampleEnd = settings.sampleEnd;
    settings_.seconds = settings.seconds;
    settings_.seed = settings.seed;
    wavefront_->setSeed(settings.seed);
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    const glm::uvec2 before(settings_.width, settings_.height), size(width, height);
    settings_.width = width;
    settings_.height = height;
    wavefront_->setCamera(camera, width, height);
    if (size != before) {
        std::swap(tiles_, spare_);
        if (size != std::exchange(spareSize_, before)) {
            makeTiles();
        }
    }
    for (const auto& tile : tiles_) {
        tile->clear();
    }
    begin(camera);
}

void Renderer::restart(const FlatScene& scene, const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    settings_.width = width;
    settings_.height = height;
    sceneIdentity_ = SceneIdentity(scene);
    LastingResources lasting = wavefront_->lasting();
    light_.reset();
    tiles_.clear();
    spare_.clear();
    spareSize_ = {0, 0};
    wavefront_.reset();  // so that no two scenes are on the device
    start_ = Clock::now();
    wavefront_ = std::make_unique<Wavefront>(device_, scene, camera, settings_, std::move(lasting));
    statistics_ = {};
    open(scene, camera);
}

void Renderer::clearStatistics()
{
    statistics_ = {};
    statistics_.schedule = wavefront_->schedule();
    wavefront_->clearStatistics();
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t seed)
{
    settings_.seed = seed;
    wavefront_->setSeed(seed);
    restart(camera, settings_.width, settings_.height);
}

void Renderer::begin(const FlatCamera& camera)
{
    film_ = emptyFilm(settings_);
    film_.pixels.resize(settings_.pixelCount());
    film_.identity = identityOf(sceneIdentity_, camera, settings_);
    film_.device = device_.description().name + ", " + device_.description().driver;
    film_.arithmetic = arithmeticFingerprint(device_);
    if (settings_.halves) {
        halves_.emplace(settings_);
    }
    foldVersion_ = 0;
    sample_ = settings_.sampleBegin;
    mean_ = roundEnd_ = commonEnd_ = 0;
    choosing_ = false;
    if (isNeighbours(settings_.adaptive)) {
        // The samples that all pixels share are never more than half of sampleEnd.
        const std::uint32_t half = std::max(kPilotSamples, (settings_.sampleEnd + 1) / 2);
        chosenBlocks_ = BlockQueue(film_.pixels.size(), (half + kBlockSamples - 1) / kBlockSamples * kBlockSamples);
        common_ = film_;
    }
    if (light_) {
        light_->begin(*wavefront_, settings_);
    }
    timesToTarget_ = std::numeric_limits<double>::infinity();
    sweeping_ = false;
    tile_ = 0;
    pixel_ = 0;
    chosen_ = film_.pixels.size();
    pictureSamples_ = resumedSamples_ = judgedSamples_ = 0;
    resumedSeconds_ = 0.0;
    aheadEnd_ = 0;
    ended_ = false;
    plannedSamples_ = chosen_ * (settings_.sampleEnd - settings_.sampleBegin);
    start_ = Clock::now();
}

Film Renderer::render(const RenderObserver& observer, const StoppingCriterion& criterion, const std::function<void()>& atEnd)
{
    start_ = Clock::now();
    plannedSamples_ =
        criterion ? film_.pixels.size() * leastSamplesForError(settings_.sampleBegin) : plannedSamples_;  // until it is known better
    Clock::time_point begin = start_;
    const auto shouldContinue = [&] { return asks(observer) || secondsSince(begin) < settings_.passSeconds; };
    const auto isEnough = [&] { return criterion && isGoodEnough(criterion); };
    if (!(resumedSamples_ > 0 && isEnough())) {
        while (advance(shouldContinue) && !isOver(observer) && !isEnough()) {
            begin = Clock::now();
        }
    }
    if (atEnd) {
        atEnd();
    }
    takeHalves();
    foldPages(film_, tiles_);
    foldSplats(film_);
    statistics_.renderSeconds = secondsSinceStart();
    readCounters();
    describe(film_);
    return std::move(film_);
}

// What the device and the open block of light paths have, which is not folded yet.
Film Renderer::pageSoFar()
{
    Film page;
    page.pixels.resize(film_.pixels.size());
    std::vector<std::unique_ptr<Tile>> copies;
    for (const auto& tile : tiles_) {
        copies.push_back(wavefront_->makeTile(tile->begin(), tile->count()));
        copies.back()->copySamples(*tile, 0);
    }
    foldPages(page, copies);
    if (light_) {
        light_->copyInto(page.splats);
    }
    return page;
}

Film Renderer::film()
{
    Film film = film_;
    const Film page = pageSoFar();
    foldPage(film, 0, page.pixels);
    glim::foldSplats(film.splats, page.splats);
    readCounters();
    describe(film);
    return film;
}

void Renderer::takeHalves()
{
    if (halves_) {
        halves_->take(pageSoFar(), sweeping_ ? sweepEnd() : sample_);
    }
}

PixelMoments Renderer::moments(std::uint32_t pixel)
{
    const Tile& tile = *tiles_[pixel / settings_.tilePixels];
    const std::unique_ptr<Tile> copy = wavefront_->makeTile(pixel, 1);
    copy->copySamples(tile, pixel - tile.begin());
    wavefront_->closeBlocks(*copy);
    return foldMoments(film_.pixels[pixel], copy->takePages().front());
}

// Sets the film's sample ranges, completeness and time.
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
    film.seconds = resumedSeconds_ + secondsSinceStart();
}

// Returns false if `shouldContinue` ended the pass before it was done.
bool Renderer::runPass(const Pass& pass, const std::function<bool()>& shouldContinue)
{
    const auto traced = wavefront_->trace(*tiles_[tile_], pass, shouldContinue);
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
    addSeconds(seconds);
    passSize_.learn(paths, seconds);
    return true;
}

// Light paths go before the camera's, so that a render that is stopped lacks none. Samples that only chosen pixels have need none of their
// own, but then all light paths are as many as if every pixel had the mean of samples, in whole blocks.
std::uint32_t Renderer::lightEnd() const
{
    const std::uint32_t ofRound = std::max(commonEnd_, roundEnd_ / kBlockSamples * kBlockSamples);
    return isNeighbours(settings_.adaptive) ? ofRound : sweepEnd();
}

bool Renderer::runLightPass(const std::function<bool()>& shouldContinue)
{
    const auto seconds = light_->trace(*wavefront_, lightEnd(), shouldContinue);
    refuseBrokenStatus(device_.description(), wavefront_->paths());
    if (!seconds) {
        return false;
    }
    addSeconds(*seconds);
    return true;
}

void Renderer::addSeconds(const PassSeconds& seconds)
{
    statistics_.passSeconds += seconds.total;
    statistics_.longestDispatch = std::max(statistics_.longestDispatch, seconds.longest);
}

// Closes the open blocks, which may be partial in adaptive renders and at the end, and folds all pages into `film`.
void Renderer::foldPages(Film& film, const std::vector<std::unique_ptr<Tile>>& tiles)
{
    for (const auto& tile : tiles) {
        wavefront_->closeBlocks(*tile);
        foldPage(film, tile->begin() - settings_.firstPixel(), tile->takePages());
    }
}

void Renderer::foldSplats(Film& film)
{
    if (light_) {
        light_->foldInto(film.splats);
    }
}

bool Renderer::asks(const RenderObserver& observer, bool betweenPasses)
{
    ended_ = !observer({pictureSamples_, plannedSamples_, secondsSinceStart(), resumedSamples_, betweenPasses}) || ended_;
    return !ended_;
}

bool Renderer::isOver(const RenderObserver& observer)
{
    return !asks(observer, true) || (settings_.seconds && secondsSinceStart() >= *settings_.seconds);
}

bool Renderer::isGoodEnough(const StoppingCriterion& criterion)
{
    const bool due = isNeighbours(settings_.adaptive) ? isBetweenRounds() && mean_ >= leastSamplesForError(settings_.sampleBegin)
                                                      : isJudgedAt(settings_.sampleBegin, sample_);
    if (sweeping_ || !due || judgedSamples_ == pictureSamples_) {
        return false;
    }
    judgedSamples_ = pictureSamples_;
    constexpr double kUnknown = 1e6;
    try {
        timesToTarget_ = std::min(criterion(film()), kUnknown);
    } catch (const std::bad_alloc&) {  // of a copy of the film: its samples are worth more than its error
        timesToTarget_ = kUnknown;
    }
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
    statistics_.transparencyCaps = status.transparencyCaps;
    statistics_.mediaCaps = status.mediaCaps;
    statistics_.nonFinite = status.nonFinite;
    statistics_.located.assign(status.located, status.located + std::min(status.nonFinite, kMaxLocated));
    statistics_.kernels = wavefront_->statistics();
    statistics_.peakDeviceMemory = device_.peakMemory();
}

// The end of the current sweep. The first samples are swept 1, 1, 2, 4, 8, 16 and 32 at a time, so that a render that is stopped early
// covers its picture evenly. Later blocks are swept whole, which keeps the rays of a pixel together.
std::uint32_t Renderer::sweepEnd() const
{
    if (sample_ < aheadEnd_) {
        return aheadEnd_;
    }
    const std::uint32_t done = sample_ - settings_.sampleBegin;
    const std::uint32_t last = isNeighbours(settings_.adaptive) ? commonEnd_ : settings_.sampleEnd;
    const std::uint32_t count = done < kBlockSamples ? std::max(1U, std::bit_floor(done)) : kBlockSamples;
    const std::uint32_t most = halves_ ? FilmHalves::nextEnd(sample_) : (sample_ / kBlockSamples + 1) * kBlockSamples;
    const std::uint32_t end = std::min({last, most, sample_ + count});
    return isCourse(settings_.adaptive) ? std::min(end, (sample_ / settings_.course.batch + 1) * settings_.course.batch) : end;
}

bool Renderer::advance(const std::function<bool()>& shouldContinue)
{
    while (isNeighbours(settings_.adaptive) && isBetweenRounds() && !isDone()) {
        startRound();
    }
    if (isDone()) {
        return false;
    }
    if (light_ && light_->sample() < lightEnd()) {
        return runLightPass(shouldContinue);
    }
    // Each chosen pixel of a round has its own first sample.
    const Pass pass = choosing_ ? nextPass(0, sweep_.sampleCount) : nextPass(sample_, sweepEnd() - sample_);
    if (!runPass(pass, shouldContinue)) {
        return false;
    }
    if (!findTile()) {
        endSweep();
    }
    return true;
}

// How many pixels have the current sweep's samples.
std::size_t Renderer::pixelsDone() const
{
    std::size_t done = pixel_;
    for (std::size_t i = 0; i < tile_; ++i) {
        done += tiles_[i]->chosenCount();
    }
    return done;
}

// Finds the tile of the sweep's next pixel; false if there is none.
bool Renderer::findTile()
{
    while (tile_ < tiles_.size() && pixel_ == tiles_[tile_]->chosenCount()) {
        ++tile_;
        pixel_ = 0;
    }
    return tile_ < tiles_.size();
}

Pass Renderer::nextPass(std::uint32_t firstSample, std::uint32_t sampleCount) const
{
    const Tile& tile = *tiles_[tile_];
    Pass pass = wavefront_->passOf(tile);
    pass.firstPixel = pixel_;
    pass.firstSample = firstSample;
    pass.sampleCount = sampleCount;
    pass.pixelCount = std::min(tile.chosenCount() - pixel_, std::max(1U, passSize_.paths() / pass.sampleCount));
    return pass;
}

void Renderer::endSweep()
{
    if (choosing_) {
        if (!chooseSweep(chosenBlocks_)) {
            endRound();
        }
        return;
    }
    sample_ = sweepEnd();
    sweeping_ = false;
    if (isCourse(settings_.adaptive) && sample_ % settings_.course.batch == 0) {
        chosen_ = choosePixels();
        plannedSamples_ = pictureSamples_ + chosen_ * (settings_.sampleEnd - sample_);
    }
    tile_ = 0;
    findTile();
    if (sample_ == FilmHalves::nextEnd(sample_ - 1)) {
        takeHalves();
    }
    if (isNeighbours(settings_.adaptive)) {
        if (sample_ == commonEnd_) {
            foldCommon();
            startChoosing();
        }
    } else if (sample_ % kPageSamples == 0) {
        foldPages(film_, tiles_);
        foldSplats(film_);
        foldVersion_ = nextFoldVersion();
    }
}

// Returns how many pixels still need samples.
std::uint64_t Renderer::choosePixels()
{
    std::uint64_t chosen = 0;
    for (const auto& tile : tiles_) {
        wavefront_->choosePixels(*tile, sample_ - settings_.sampleBegin);
        chosen += tile->chosenCount();
    }
    return chosen;
}

}  // namespace glim
