#include "host/render/renderer.hpp"

#include "host/render/allocate_samples.hpp"
#include "host/render/check_status.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <new>
#include <random>
#include <utility>

namespace glim {

Renderer::Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : settings_(settings),
      sceneIdentity_(scene),
      start_(Clock::now()),
      resources_(std::make_unique<RenderResources>(device, scene, camera, settings)),
      passSize_(scene, settings, resources_->paths().capacity() / (settings.catcher ? 2 : 1)),
      plan_(settings, tracesLight(scene, settings))
{
    open(scene, camera);
}

Renderer::Renderer(const Renderer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : settings_(settings),
      sceneIdentity_(other.sceneIdentity_),
      start_(Clock::now()),
      resources_(std::make_unique<RenderResources>(*other.resources_, scene, camera, settings)),
      passSize_(scene, settings, resources_->paths().capacity() / (settings.catcher ? 2 : 1)),
      plan_(settings, tracesLight(scene, settings))
{
    open(scene, camera);
}

void Renderer::open(const FlatScene& scene, const FlatCamera& camera)
{
    std::optional<float> scale;
    if (tracesLight(scene, settings_)) {
        light_.emplace(scene, settings_, resources_->paths().capacity());
        scale = splatScale(scene);
    }
    films_.emplace(*resources_, settings_, emptyFilmOf(camera), scale);
    refuseBrokenStatus(resources_->device.description(), resources_->paths());
    statistics_.schedule = resources_->schedule;
    statistics_.compileSeconds = resources_->compileSeconds;
    statistics_.uploadSeconds = secondsSinceStart() - statistics_.compileSeconds;
    begin();
}

Film Renderer::emptyFilmOf(const FlatCamera& camera) const
{
    Film film = emptyFilm(settings_);
    film.identity = makeIdentity(sceneIdentity_, camera, settings_);
    film.device = resources_->device.description().name + ", " + resources_->device.description().driver;
    film.arithmetic = arithmeticFingerprint(resources_->device);
    return film;
}

void Renderer::begin()
{
    if (light_) {
        light_->begin(settings_);
    }
    plan_ = SamplePlan(settings_, light_.has_value());
    resumedSeconds_ = 0.0;
    ended_ = false;
    start_ = Clock::now();
}

void Renderer::setSampling(const RenderSettings& settings)
{
    settle();
    settings_.sampleBegin = settings.sampleBegin;
    settings_.sampleEnd = settings.sampleEnd;
    settings_.seconds = settings.seconds;
    settings_.seed = settings.seed;
    resources_->parameters.setSeed(settings.seed);
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    settle();
    settings_.width = width;
    settings_.height = height;
    resources_->parameters.setCamera(camera, width, height);
    films_->restart(settings_, emptyFilmOf(camera));
    begin();
}

void Renderer::restart(const FlatScene& scene, const FlatCamera& camera, std::uint32_t width, std::uint32_t height)
{
    settle();
    settings_.width = width;
    settings_.height = height;
    sceneIdentity_ = SceneIdentity(scene);
    Device& device = resources_->device;
    LastingResources lasting = resources_->lasting();
    light_.reset();
    films_.reset();
    resources_.reset();  // so that no two scenes are on the device
    start_ = Clock::now();
    resources_ = std::make_unique<RenderResources>(device, scene, camera, settings_, std::move(lasting));
    statistics_ = {};
    open(scene, camera);
}

void Renderer::restart(const FlatCamera& camera, std::uint32_t seed)
{
    settle();
    settings_.seed = seed;
    resources_->parameters.setSeed(seed);
    restart(camera, settings_.width, settings_.height);
}

void Renderer::clearStatistics()
{
    statistics_ = {};
    statistics_.schedule = resources_->schedule;
    resources_->clearStatistics();
}

Film Renderer::render(const RenderObserver& observer, const StoppingCriterion& criterion, const std::function<void()>& atEnd)
{
    start_ = Clock::now();
    if (criterion) {
        plan_.expectTarget();
    }
    Clock::time_point begin = start_;
    const auto shouldContinue = [&] { return asks(observer) || secondsSince(begin) < settings_.passSeconds; };
    const auto isEnough = [&] { return criterion && isGoodEnough(criterion); };
    if (!(plan_.resumedSamples() > 0 && isEnough())) {
        while (step(shouldContinue, true) && !isOver(observer) && !isEnough()) {
            begin = Clock::now();
        }
        settle();
    }
    if (atEnd) {
        atEnd();
    }
    if (const auto half = plan_.chosenHalf()) {
        films_->takeChosenHalves(*half);
    } else {
        films_->takeHalves(plan_.endOfSamples(), true);
    }
    films_->takeSplatHalves(plan_.lightSample(), true);
    Film film = films_->takeFilm();
    statistics_.renderSeconds = secondsSinceStart();
    readCounters();
    describe(film);
    return film;
}

bool Renderer::advance(const std::function<bool()>& shouldContinue) { return step(shouldContinue, false); }

// `startsAhead`: may leave the pass to the device, and end it later.
bool Renderer::step(const std::function<bool()>& shouldContinue, bool startsAhead)
{
    while (plan_.beginRound()) {
        carryOutTasks();
    }
    if (plan_.isDone()) {
        return false;
    }
    if (const auto pass = light_ ? plan_.nextLight(light_->paths()) : std::nullopt) {
        settle();
        return trace(*pass, shouldContinue);
    }
    const CameraPass pass = plan_.next(passSize_.paths());
    if (startsAhead && PassTracer(*resources_).startsAhead()) {
        start(pass);
    } else {
        settle();
        if (!trace(pass, shouldContinue)) {
            return false;
        }
    }
    plan_.finish(pass, passSize_.paths());
    carryOutTasks();
    return true;
}

Pass Renderer::passOf(const CameraPass& planned) const
{
    Pass pass = films_->tiles()[planned.tile]->pass();
    pass.firstPixel = planned.firstPixel;
    pass.pixelCount = planned.pixelCount;
    pass.firstSample = planned.firstSample;
    pass.sampleCount = planned.sampleCount;
    return pass;
}

// Returns false if `shouldContinue` ended the pass before it was done.
bool Renderer::trace(const CameraPass& planned, const std::function<bool()>& shouldContinue)
{
    const auto seconds = PassTracer(*resources_).trace(*films_->tiles()[planned.tile], passOf(planned), shouldContinue);
    refuseBrokenStatus(resources_->device.description(), resources_->paths());
    if (seconds) {
        learn(planned.paths(), *seconds);
    }
    return seconds.has_value();
}

// Ends the pass before, which the device traces while this one is recorded.
void Renderer::start(const CameraPass& planned)
{
    PassTracer tracer(*resources_);
    const Tile& tile = *films_->tiles()[planned.tile];
    std::unique_ptr<StartedPass> next = tracer.start(tile, passOf(planned));
    if (started_ && endStarted()) {
        next->recording.finish();
        next = tracer.start(tile, passOf(planned));
    }
    started_ = std::move(next);
}

// Returns whether the pass was late.
bool Renderer::endStarted()
{
    const PassTracer::Ended ended = PassTracer(*resources_).end(*started_);
    refuseBrokenStatus(resources_->device.description(), resources_->paths());
    learn(started_->progress.pass.pixelCount * started_->progress.pass.sampleCount, ended.seconds);
    return ended.wasLate;
}

// Whatever else uses the film or the device's paths comes after it.
void Renderer::settle()
{
    if (started_) {
        endStarted();
        started_.reset();
    }
}

void Renderer::learn(std::uint32_t paths, const PassSeconds& seconds)
{
    if (statistics_.samples == 0) {
        statistics_.firstPassSeconds = statistics_.uploadSeconds + statistics_.compileSeconds + secondsSinceStart();
    }
    statistics_.samples += paths;
    addSeconds(seconds);
    passSize_.learn(paths, seconds);
}

bool Renderer::trace(const LightPass& pass, const std::function<bool()>& shouldContinue)
{
    PassTracer tracer(*resources_);
    const auto countRays = [&] {
        readCounters();
        return statistics_.cameraAndBounceRays + statistics_.shadowRays;
    };
    const std::uint64_t before = settings_.comparesPaths ? countRays() : 0;
    const auto seconds = light_->trace(tracer, films_->splats(), pass, shouldContinue);
    statistics_.lightPathRays += settings_.comparesPaths ? countRays() - before : 0;
    refuseBrokenStatus(resources_->device.description(), resources_->paths());
    if (!seconds) {
        return false;
    }
    films_->addSplats(pass);
    plan_.finish(pass);
    if (plan_.lightSample() == FilmHalves::nextEnd(plan_.lightSample() - 1)) {
        films_->takeSplatHalves(plan_.lightSample(), false);
    }
    addSeconds(*seconds);
    return true;
}

void Renderer::addSeconds(const PassSeconds& seconds)
{
    statistics_.passSeconds += seconds.total;
    statistics_.longestDispatch = std::max(statistics_.longestDispatch, seconds.longest);
}

void Renderer::carryOutTasks()
{
    while (const std::optional<PlanTask> task = plan_.takeTask()) {
        carryOut(*task);
    }
}

void Renderer::carryOut(PlanTask task)
{
    settle();
    const SquaredError error = settings_.adaptive == Adaptive::Neighbours ? SquaredError::Relative : SquaredError::Absolute;
    switch (task) {
    case PlanTask::ChooseAllPixels: films_->chooseAllPixels(); break;
    case PlanTask::ChoosePixels: films_->choosePixels(plan_.sweep()); break;
    case PlanTask::TestPixels: plan_.choose(films_->testPixels(plan_.sampleCount())); break;
    case PlanTask::TakeHalves: films_->takeHalves(plan_.endOfSamples(), false); break;
    case PlanTask::TakeFirstHalf: films_->takeChosenHalves(0); break;
    case PlanTask::TakeSecondHalf: films_->takeChosenHalves(1); break;
    case PlanTask::FoldCommon: films_->foldCommon(); break;
    case PlanTask::Allocate: plan_.allocate(computeShares(films_->common(), error), films_->halves(), passSize_.paths()); break;
    case PlanTask::Fold: films_->fold(); break;
    }
}

bool Renderer::asks(const RenderObserver& observer, bool betweenPasses)
{
    ended_ =
        !observer({plan_.pictureSamples(), plan_.plannedSamples(), secondsSinceStart(), plan_.resumedSamples(), betweenPasses}) || ended_;
    return !ended_;
}

bool Renderer::isOver(const RenderObserver& observer)
{
    return !asks(observer, true) || (settings_.seconds && secondsSinceStart() >= *settings_.seconds);
}

bool Renderer::isGoodEnough(const StoppingCriterion& criterion)
{
    if (!plan_.isJudgedNow()) {
        return false;
    }
    constexpr double kUnknown = 1e6;
    try {
        return plan_.judge(std::min(criterion(film()), kUnknown));
    } catch (const std::bad_alloc&) {  // of a copy of the film: its samples are worth more than its error
        return plan_.judge(kUnknown);
    }
}

Film Renderer::film()
{
    settle();
    Film film = films_->sum();
    readCounters();
    describe(film);
    return film;
}

// Sets the film's sample ranges, completeness and time.
void Renderer::describe(Film& film)
{
    plan_.describe(film);
    film.seconds = resumedSeconds_ + secondsSinceStart();
}

void Renderer::readCounters()
{
    const auto wide = [](uvec2 words) { return std::uint64_t{words.y} << 32 | words.x; };
    const RayCounts rays = download<RayCounts>(resources_->paths().rayCounts(), 1)[0];
    const Status status = download<Status>(resources_->paths().status(), 1)[0];
    statistics_.cameraAndBounceRays = wide(rays.closest);
    statistics_.shadowRays = wide(rays.shadow);
    statistics_.loopCaps = status.loopCaps;
    statistics_.overflows = status.overflows;
    statistics_.transparencyCaps = status.transparencyCaps;
    statistics_.mediaCaps = status.mediaCaps;
    statistics_.scatteringCaps = status.scatteringCaps;
    statistics_.cutThroughput = static_cast<double>(wide(status.cutThroughput)) * static_cast<double>(kCutUnit);
    statistics_.nonFinite = status.nonFinite;
    statistics_.located.assign(status.located, status.located + std::min(status.nonFinite, kMaxLocated));
    statistics_.kernels = resources_->statistics;
    statistics_.peakDeviceMemory = resources_->device.peakMemory();
}

std::optional<Checkpoint> Renderer::checkpoint()
{
    settle();
    std::optional<SampleProgress> progress = plan_.progress();
    if (!progress) {
        return std::nullopt;
    }
    Checkpoint checkpoint = films_->checkpoint(*std::move(progress));
    checkpoint.progress.describe(checkpoint.film, settings_.sampleBegin);
    checkpoint.film.seconds = resumedSeconds_ + secondsSinceStart();
    return checkpoint;
}

void Renderer::resume(Checkpoint checkpoint)
{
    resumedSeconds_ = checkpoint.film.seconds;
    plan_.resume(std::move(checkpoint.progress), passSize_.paths());
    films_->resume(std::move(checkpoint));
    carryOutTasks();
    statistics_.resumedSamples = plan_.resumedSamples();
}

std::optional<Film> Renderer::sampleControl(const Film& film, const std::function<bool()>& shouldContinue)
{
    settle();
    const double share = std::max(0.01, 64.0 / static_cast<double>(film.pixels.size()));
    std::vector<std::uint32_t> needed(film.pixels.size(), 0);
    std::mt19937 random(settings_.seed);
    for (std::size_t i = 0; i < needed.size(); ++i) {
        const bool isControl = static_cast<double>(random()) < share * 0x1p32;
        needed[i] = isControl ? (film.pixels[i].count + kBlockSamples - 1) / kBlockSamples : 0;
    }
    const std::uint32_t begin = (film.sampleRanges.back().second + kBlockSamples - 1) / kBlockSamples * kBlockSamples;
    BlockQueue blocks(film.pixels.size(), begin);
    blocks.add(needed);
    const RenderStatistics before = statistics_;
    bool isWhole = true;
    while (const std::optional<Sweep> sweep = isWhole ? blocks.take(passSize_.paths()) : std::nullopt) {
        films_->choosePixels(sweep->pixels);
        SweepCursor cursor(countByTile(sweep->pixels, settings_));
        while (isWhole && !cursor.isAtEnd()) {
            const CameraPass pass = cursor.next(0, sweep->sampleCount, passSize_.paths());
            isWhole = trace(pass, shouldContinue);
            cursor.finish(pass);
        }
    }
    statistics_ = before;
    if (!isWhole) {
        return std::nullopt;
    }
    Film control;
    control.pixels = films_->takePages();
    return control;
}

}  // namespace glim
