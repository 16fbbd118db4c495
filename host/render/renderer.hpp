// Renders: sweeps over the picture, pass after pass.
#pragma once

#include "host/clock.hpp"
#include "host/render/block_queue.hpp"
#include "host/render/checkpoint.hpp"
#include "host/render/film_halves.hpp"
#include "host/render/film_identity.hpp"
#include "host/render/light_passes.hpp"
#include "host/render/pass_size.hpp"
#include "host/render/wavefront.hpp"

#include <functional>

namespace glim {

struct RenderStatistics {
    Schedule schedule = Schedule::Auto;  // the one used
    double uploadSeconds = 0.0, compileSeconds = 0.0, renderSeconds = 0.0;
    double passSeconds = 0.0;  // device time of all passes; 0 if unknown
    std::map<std::string, KernelStatistics> kernels;
    double longestDispatch = 0.0;      // seconds, on the device, after compilation
    std::uint64_t samples = 0;         // over all pixels
    std::uint64_t resumedSamples = 0;  // of earlier runs, not among these
    std::uint64_t cameraAndBounceRays = 0, shadowRays = 0;
    std::uint32_t transparencyCaps = 0, mediaCaps = 0;  // as in Status
    std::uint32_t loopCaps = 0, overflows = 0;          // as in Status; a render with any of them throws
    std::uint32_t nonFinite = 0;                        // samples left out
    std::vector<Located> located;                       // the first of them
    std::uint64_t peakDeviceMemory = 0;                 // bytes
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

    // What there is between two passes or at the end, but for blocks that are not finished. Nothing before the first block, or if the
    // adaptive rule is the course's.
    std::optional<Checkpoint> checkpoint() const;
    // Goes on from a checkpoint of this picture, which the settings must allow, as if there had been no interruption. To be called before
    // render.
    bool canResume(const Checkpoint& checkpoint) const;
    void resume(Checkpoint checkpoint);

    // After an adaptive render: takes new samples of one pixel in a hundred (of 64 or so in small pictures), as many as `film` has of
    // each. They are independent of the samples that the allocation was based on, and are in no statistics. Returns nothing if
    // `shouldContinue` ended it.
    std::optional<Film> sampleControl(const Film& film, const std::function<bool()>& shouldContinue);

    // Renders in steps: each call does one pass. Returns false once nothing is left to do, or if `shouldContinue`, asked now and then,
    // ended the pass, which is then discarded. Throws as render does.
    bool advance(const std::function<bool()>& shouldContinue = nullptr);
    bool isDone() const { return chosen_ == 0 || (isNeighbours(settings_.adaptive) ? mean_ : sample_) == settings_.sampleEnd; }
    // The film so far; sampling may go on.
    Film film();
    PixelMoments moments(std::uint32_t pixel);  // as in film(), but faster
    // Of the film so far, at the end of a block or of the render; null unless the settings ask for them.
    const FilmHalves* halves() const { return halves_ ? &*halves_ : nullptr; }
    // The hit of one ray, which is not part of the picture. Needs Schedule::Wavefront.
    PathHit traceRay(const PathRay& ray) { return wavefront_->traceRays(*tiles_.front(), {&ray, 1})[0]; }
    // Traces one sample of a pixel again, and adds it to no film.
    PathRadiance traceSample(std::uint32_t pixel, std::uint32_t sample) { return wavefront_->traceSample(pixel, sample); }
    // What the next picture has of samples, seed and time. The other settings must be the same as before.
    void setSampling(const RenderSettings& settings);
    // Takes other kernels if the present ones do not serve this camera, which is close to large triangles, or no longer.
    void adapt(const FlatScene& scene, const FlatCamera& camera) { wavefront_->adapt(scene, camera); }
    // Starts another picture of the scene, from a camera that the kernels serve.
    void restart(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    // Starts a picture of another scene. Keeps the kernels if they serve it.
    void restart(const FlatScene& scene, const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    // Starts the same picture from other random numbers.
    void restart(const FlatCamera& camera, std::uint32_t seed);

    // Samples per chosen pixel (with --adaptive neighbours the mean over all pixels), and samples of all pixels together.
    std::uint32_t sampleCount() const { return mean_ > 0 ? mean_ : sample_ - settings_.sampleBegin; }
    std::uint64_t pictureSamples() const { return pictureSamples_; }
    // For display: the tiles on the device have what is not folded yet, `folded` has the rest. The version changes whenever `folded`
    // does; 0 while nothing is folded.
    const std::vector<std::unique_ptr<Tile>>& tiles() const { return tiles_; }
    const Film& folded() const { return film_; }
    std::uint64_t foldVersion() const { return foldVersion_; }

    const RenderSettings& settings() const { return settings_; }
    Device& device() const { return device_; }
    SharedResources& shared() const { return wavefront_->shared(); }
    const RenderStatistics& statistics() const { return statistics_; }
    // Those of the next picture begin at 0, as if the scene had been there before.
    void clearStatistics();

private:
    void open(const FlatScene& scene, const FlatCamera& camera);
    void makeTiles();
    void begin(const FlatCamera& camera);
    double secondsSinceStart() const { return secondsSince(start_); }
    void describe(Film& film) const;
    bool runPass(const Pass& pass, const std::function<bool()>& shouldContinue);
    std::uint32_t lightEnd() const;
    bool runLightPass(const std::function<bool()>& shouldContinue);
    void addSeconds(const PassSeconds& seconds);
    bool asks(const RenderObserver& observer, bool betweenPasses = false);
    // Unique over all renderers, so that the folded pages of one are never taken for those of another.
    static std::uint64_t nextFoldVersion();

    // Which samples of which pixels come next.
    bool isBetweenRounds() const { return mean_ == roundEnd_; }
    std::uint32_t sweepEnd() const;
    bool findTile();
    std::size_t pixelsDone() const;
    Pass nextPass(std::uint32_t firstSample, std::uint32_t sampleCount) const;
    void endSweep();
    std::uint64_t choosePixels();
    void startRound();
    void startChoosing();
    void endRound();
    void foldCommon();
    bool chooseSweep(BlockQueue& blocks);

    Film pageSoFar();
    void takeHalves();
    void foldPages(Film& film, const std::vector<std::unique_ptr<Tile>>& tiles);
    void foldSplats(Film& film);
    bool isOver(const RenderObserver& observer);
    bool isGoodEnough(const StoppingCriterion& criterion);
    void readCounters();

    Device& device_;
    RenderSettings settings_;
    SceneIdentity sceneIdentity_;
    RenderStatistics statistics_;
    Clock::time_point start_;
    PassSize passSize_;
    bool ended_ = false;  // by the observer

    std::unique_ptr<Wavefront> wavefront_;
    std::vector<std::unique_ptr<Tile>> tiles_;
    std::vector<std::unique_ptr<Tile>> spare_;  // tiles of the previous size, to which a window soon returns
    glm::uvec2 spareSize_{0, 0};

    Film film_;  // the pages folded so far
    std::optional<FilmHalves> halves_;
    std::uint64_t foldVersion_ = 0;
    std::uint32_t sample_ = 0;  // first sample of the current sweep over all pixels
    bool sweeping_ = false;     // the sweep, or the round's chosen part, has had a pass
    std::size_t tile_ = 0;      // the tile of the next pass
    std::uint32_t pixel_ = 0;   // its first pixel, among the tile's chosen ones
    std::uint64_t chosen_ = 0;  // pixels that the sweep goes over
    std::uint64_t pictureSamples_ = 0, plannedSamples_ = 0, resumedSamples_ = 0;
    double resumedSeconds_ = 0.0;
    std::uint32_t aheadEnd_ = 0;       // of the sweep that a checkpoint had begun
    std::uint64_t judgedSamples_ = 0;  // pictureSamples_ when the criterion was last asked
    double timesToTarget_ = 0.0;       // the criterion's last answer; infinite before the first

    std::optional<LightPasses> light_;  // of scenes whose caustics need them

    // For --adaptive neighbours.
    Film common_;                  // the samples that all pixels share
    std::uint32_t commonEnd_ = 0;  // their number at the end of the current round
    BlockQueue chosenBlocks_;      // the samples of chosen pixels
    bool choosing_ = false;        // the current sweep is over chosen pixels
    Sweep sweep_;                  // that one
    std::uint32_t mean_ = 0;       // mean samples per pixel after the last round
    std::uint32_t roundEnd_ = 0;   // the same after the current round
};

}  // namespace glim
