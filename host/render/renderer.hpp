// Renders: sweeps over the picture, pass after pass.
#pragma once

#include "host/render/block_queue.hpp"
#include "host/render/film.hpp"
#include "host/render/pass_size.hpp"
#include "host/render/wavefront.hpp"

#include <chrono>
#include <functional>

namespace glim {

struct RenderStatistics {
    Schedule schedule = Schedule::Auto;  // that was used
    double uploadSeconds = 0.0, compileSeconds = 0.0, renderSeconds = 0.0;
    double passSeconds = 0.0;  // of all passes, on the device; 0 if it cannot tell
    std::map<std::string, KernelStatistics> kernels;
    double longestDispatch = 0.0;  // seconds, on the device, after compilation
    std::uint64_t samples = 0;     // over all pixels
    std::uint64_t cameraAndBounceRays = 0, shadowRays = 0;
    std::uint32_t loopCaps = 0, overflows = 0;  // of Status; a render that had any has thrown
    std::uint32_t nonFinite = 0;   // samples left out
    std::vector<Located> located;  // the first of them
    std::uint64_t peakDeviceMemory = 0;  // bytes
};

struct RenderProgress {
    std::uint64_t samples, totalSamples;  // over all pixels; of an adaptive render, total if no further pixel is done early
    double seconds;
};

// Judges a film that is finished so far: how many times its samples it would need; at most 1: it is good enough.
using FilmJudge = std::function<double(const Film&)>;

// Called several times a second; false ends the render after the pass under way or, if that takes seconds, without it.
using RenderObserver = std::function<bool(const RenderProgress&)>;

class Renderer {
public:
    // Uploads the scene and compiles the kernels for what it needs.
    Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // The same of the scene and in the buffers of `lender`, which must outlive it; only one of them may be at work.
    Renderer(const Renderer& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Samples until sampleEnd, the stop rule, the time limit, the observer or the judge, if there is one, ends it. Every pixel of the
    // film has what was finished; the counts say how much. Throws DeviceError if the driver cut a loop short or a queue overflowed:
    // no film is better than a wrong one. Once per picture.
    Film render(const RenderObserver& observer, const FilmJudge& judge = nullptr);

    // After an adaptive render: new samples of one pixel in a hundred (in small pictures of 64 or so), as many as `film` has of each,
    // and in no statistics. What was chosen by the old ones, those do not know. Nothing if `goesOn` ended it.
    std::optional<Film> sampleControl(const Film& film, const std::function<bool()>& goesOn);

    // The same as render in steps: a pass of work. False once nothing is left to do, or if `goesOn`, asked now and then, ended the
    // pass, of which nothing is kept then. Throws as render.
    bool advance(const std::function<bool()>& goesOn = nullptr);
    bool isDone() const
    {
        return chosen_ == 0 || (isNeighbours(settings_.adaptive) ? mean_ : sample_) == settings_.sampleEnd;
    }
    // What is finished; sampling may go on.
    Film film();
    PixelMoments moments(std::uint32_t pixel);  // of film(), faster
    // What one ray meets; no part of the picture. Needs Schedule::Wavefront.
    PathHit traceRay(const PathRay& ray) { return wavefront_->traceRays(*slabs_.front(), {&ray, 1})[0]; }
    // A sample of a pixel once more, and in no film.
    PathRadiance traceSample(std::uint32_t pixel, std::uint32_t sample) { return wavefront_->traceSample(pixel, sample); }
    // Another picture of the scene. The camera has a lens if and only if the first one had.
    void restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    // The same picture from other random numbers.
    void restart(const FlatCamera& camera, std::uint32_t seed);

    // Samples that every chosen pixel has (of --adaptive neighbours that pixels have on average), and those of all pixels together.
    std::uint32_t sampleCount() const { return mean_ > 0 ? mean_ : sample_ - settings_.sampleBegin; }
    std::uint64_t pictureSamples() const { return pictureSamples_; }
    // For who looks at the film on the device, which has what was not folded yet. The version changes whenever `folded` does; 0 while
    // nothing is folded.
    const std::vector<std::unique_ptr<Slab>>& slabs() const { return slabs_; }
    const Film& folded() const { return film_; }
    std::uint64_t foldVersion() const { return foldVersion_; }

    const RenderSettings& settings() const { return settings_; }
    const RenderStatistics& statistics() const { return statistics_; }

private:
    using Clock = std::chrono::steady_clock;

    void open(const FlatCamera& camera);
    void makeSlabs();
    void begin(const FlatCamera& camera);
    void describe(Film& film) const;
    bool runPass(const Pass& pass, const std::function<bool()>& goesOn);
    bool asks(const RenderObserver& observer);
    // Of all renderers together: what one has folded is never taken for what another has.
    static std::uint64_t nextFoldVersion();

    // In renderer_sweeps.cpp.
    bool isBetweenRounds() const { return mean_ == roundEnd_; }
    std::uint32_t sweepEnd() const;
    bool findSlab();
    Pass nextPass(std::uint32_t firstSample, std::uint32_t sampleCount) const;
    void endSweep();
    std::uint64_t choosePixels();
    void startRound();
    void startChoosing();
    void endRound();
    void foldCommon();
    bool chooseSweep(BlockQueue& blocks);

    void foldPages(Film& film, const std::vector<std::unique_ptr<Slab>>& slabs);
    bool isOver(const RenderObserver& observer);
    bool isGoodEnough(const FilmJudge& judge);
    void readCounters();

    Device& device_;
    RenderSettings settings_;
    std::uint64_t sceneFingerprint_;
    RenderStatistics statistics_;
    Clock::time_point start_;
    PassSize passSize_;
    bool ended_ = false;  // by the observer

    std::unique_ptr<Wavefront> wavefront_;
    std::vector<std::unique_ptr<Slab>> slabs_;
    std::vector<std::unique_ptr<Slab>> spare_;  // of the size before, to which a window soon returns
    glm::uvec2 spareSize_{0, 0};

    Film film_;                      // the pages folded so far
    std::uint64_t foldVersion_ = 0;
    std::uint32_t sample_ = 0;       // first of the sweep under way over all pixels
    bool sweeping_ = false;          // the sweep, or the round's choice, has had a pass
    std::size_t slab_ = 0;           // of the next pass
    std::uint32_t pixel_ = 0;        // its first one, among the slab's chosen
    std::uint64_t chosen_ = 0;       // pixels that the sweep goes over
    std::uint64_t pictureSamples_ = 0, plannedSamples_ = 0;
    std::uint64_t judgedSamples_ = 0;  // of the picture, when it was judged last
    double timesToTarget_ = 0.0;       // that it found; infinite before

    // Of --adaptive neighbours.
    Film common_;                     // the samples of all pixels alike
    std::uint32_t commonEnd_ = 0;     // their number in the round under way
    BlockQueue chosenBlocks_;         // the others
    bool choosing_ = false;           // the sweep under way is of them
    std::uint32_t sweepSamples_ = 0;  // that each pixel of it has
    std::uint32_t mean_ = 0;          // samples of pixels after the last round
    std::uint32_t roundEnd_ = 0;      // after the one under way
};

}  // namespace glim
