// Renders: asks a plan which samples come next, traces them, and adds them to a film.
#pragma once

#include "host/clock.hpp"
#include "host/render/film_accumulator.hpp"
#include "host/render/film_identity.hpp"
#include "host/render/light_passes.hpp"

#include <cassert>
#include <functional>
#include <memory>

namespace glim {

struct RenderStatistics {
    Schedule schedule = Schedule::Auto;  // the one used
    double uploadSeconds = 0.0, compileSeconds = 0.0, renderSeconds = 0.0;
    double firstPassSeconds = 0.0;  // from the upload to the end of the first pass: when there is a picture
    double passSeconds = 0.0;       // of all passes, on the device; by the host's clock if it has none
    std::map<std::string, KernelStatistics> kernels;
    double longestDispatch = 0.0;      // seconds, on the device, after compilation
    std::uint64_t samples = 0;         // over all pixels
    std::uint64_t resumedSamples = 0;  // of earlier runs, not among these
    std::uint64_t cameraAndBounceRays = 0, shadowRays = 0;
    std::uint64_t lightPathRays = 0;                                        // among these, with RenderSettings::comparesPaths
    std::uint32_t transparencyCaps = 0, mediaCaps = 0, scatteringCaps = 0;  // as in Status
    double cutThroughput = 0.0;                                             // mean throughput, summed over the paths of scatteringCaps
    std::uint32_t loopCaps = 0, overflows = 0;                              // as in Status; a render with any of them throws
    std::uint32_t nonFinite = 0;                                            // samples left out
    std::vector<Located> located;                                           // the first of them
    std::uint64_t peakDeviceMemory = 0;                                     // bytes
};

struct RenderProgress {
    std::uint64_t samples, totalSamples;  // over all pixels; in adaptive renders, totalSamples assumes that no further pixel ends early
    double seconds;
    std::uint64_t resumedSamples = 0;  // of `samples`, those of earlier runs
    bool betweenPasses = false;        // Renderer::checkpoint() may be called
};

// By what factor the samples of the film so far must still grow; at most 1 ends the render.
using StoppingCriterion = std::function<double(const Film&)>;

// Called several times a second. False ends the render after the current pass or, if that takes seconds, without it.
using RenderObserver = std::function<bool(const RenderProgress&)>;

class Renderer {
public:
    // Uploads the scene and compiles the kernels for what it needs.
    Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Shares the resources of `other`, a renderer of the same scene that must outlive this one. Only one of them may render at a time.
    Renderer(const Renderer& other, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Samples until sampleEnd, the stopping rule, the time limit, the observer or the criterion (if any) ends it. The film has all finished
    // samples; its counts say how many each pixel has. Throws DeviceError if the driver cut a loop short or a queue overflowed: no film
    // is better than a wrong one. To be called once per picture.
    // Calls `atEnd`, if any, before what is not folded yet is.
    Film render(const RenderObserver& observer, const StoppingCriterion& criterion = nullptr, const std::function<void()>& atEnd = nullptr);

    // What there is between two passes or at the end, if the plan has progress to go on from.
    std::optional<Checkpoint> checkpoint();
    // Goes on from a checkpoint of this picture, which the plan can resume, as if there had been no interruption. To be called before
    // render.
    void resume(Checkpoint checkpoint);

    // After an adaptive render: takes new samples of one pixel in a hundred (of 64 or so in small pictures), as many as `film` has of
    // each. They are independent of the samples that the allocation was based on, and are in no statistics. Returns nothing if
    // `shouldContinue` ended it.
    std::optional<Film> sampleControl(const Film& film, const std::function<bool()>& shouldContinue);

    // Renders in steps: each call does one pass. Returns false once nothing is left to do, or if `shouldContinue`, asked now and then,
    // ended the pass, which is then discarded. Throws as render does.
    bool advance(const std::function<bool()>& shouldContinue = nullptr);
    // The film so far; sampling may go on.
    Film film();
    // Of this picture, from now on.
    void keepHalves() { films_->keepHalves(); }
    PixelMoments moments(std::uint32_t pixel)  // as in film(), but faster
    {
        settle();
        return films_->sum(pixel);
    }

    // What the next picture has of samples, seed and time. The other settings must be the same as before.
    void setSampling(const RenderSettings& settings);
    // Takes other kernels if the present ones do not serve this camera, which is close to large triangles, or no longer.
    void adapt(const FlatScene& scene, const FlatCamera& camera) { resources_->adapt(scene, camera); }
    // Starts another picture of the scene, from a camera that the kernels serve.
    void restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    // Starts a picture of another scene. Keeps the kernels if they serve it.
    void restart(const FlatScene& scene, const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    // Starts the same picture from other random numbers.
    void restart(const FlatCamera& camera, std::uint32_t seed);

    const SamplePlan& plan() const { return plan_; }
    const FilmAccumulator& films() const
    {
        assert(!started_);
        return *films_;
    }
    const RenderSettings& settings() const { return settings_; }
    // For what is traced between passes, such as single rays (ray_tracer.hpp) and samples (replay.hpp).
    RenderResources& resources() const
    {
        assert(!started_);
        return *resources_;
    }
    const RenderStatistics& statistics() const { return statistics_; }
    // Those of the next picture begin at 0, as if the scene had been there before.
    void clearStatistics();

private:
    void open(const FlatScene& scene, const FlatCamera& camera);
    Film emptyFilmOf(const FlatCamera& camera) const;
    void begin();
    double secondsSinceStart() const { return secondsSince(start_); }
    bool step(const std::function<bool()>& shouldContinue, bool startsAhead);
    bool trace(const LightPass& pass, const std::function<bool()>& shouldContinue);
    bool trace(const CameraPass& pass, const std::function<bool()>& shouldContinue);
    Pass passOf(const CameraPass& planned) const;
    void start(const CameraPass& pass);
    bool endStarted();
    void settle();
    void learn(std::uint32_t paths, const PassSeconds& seconds);
    void addSeconds(const PassSeconds& seconds);
    void carryOutTasks();
    void carryOut(PlanTask task);
    bool asks(const RenderObserver& observer, bool betweenPasses = false);
    bool isOver(const RenderObserver& observer);
    bool isGoodEnough(const StoppingCriterion& criterion);
    void describe(Film& film);
    void readCounters();

    RenderSettings settings_;
    SceneIdentity sceneIdentity_;
    RenderStatistics statistics_;
    Clock::time_point start_;
    double resumedSeconds_ = 0.0;
    bool ended_ = false;  // by the observer

    std::unique_ptr<RenderResources> resources_;
    PassSize passSize_;
    std::optional<LightPasses> light_;  // of scenes whose caustics need them
    std::optional<FilmAccumulator> films_;
    SamplePlan plan_;
    std::unique_ptr<StartedPass> started_;  // counted by the plan, but not yet ended; only while render() runs
};

}  // namespace glim
