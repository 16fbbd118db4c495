// Which samples of which pixels come next, and which have been taken. Values, without a device.
//
// A pass traces some samples of some pixels to their end. A sweep is the passes that give all pixels, or those that an adaptive render has
// chosen, the same number of samples. --adaptive neighbours works in rounds: sweeps over all pixels, then sweeps over chosen ones. Chosen
// pixels take blocks of samples with higher indices than any block that all pixels will have.
//
// Which pixels share a pass depends on measured time: callers say how many `paths` it should have. The order of a pixel's samples does not
// depend on time.
#pragma once

#include "host/render/block_queue.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/limits.h"

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace glim {

class FilmHalves;

// Samples of some of a tile's chosen pixels.
struct CameraPass {
    std::size_t tile = 0;
    std::uint32_t firstPixel = 0, pixelCount = 0;    // among those that are chosen in the tile
    std::uint32_t firstSample = 0, sampleCount = 0;  // firstSample is added to each chosen pixel's own

    std::uint32_t paths() const { return pixelCount * sampleCount; }
};

// All light paths of some samples of the picture, which are of one block.
struct LightPass {
    std::uint32_t firstSample = 0, sampleCount = 0;
};

// The passes of a sweep, tile after tile.
class SweepCursor {
public:
    SweepCursor() = default;
    // Over as many chosen pixels of each tile.
    explicit SweepCursor(std::vector<std::uint32_t> counts)
        : counts_(std::move(counts))
    {
        skipTiles();
    }

    bool isAtEnd() const { return tile_ == counts_.size(); }
    CameraPass next(std::uint32_t firstSample, std::uint32_t sampleCount, std::uint32_t paths) const;
    void finish(const CameraPass& pass);
    std::uint64_t pixels() const;    // of the sweep
    std::size_t pixelsDone() const;  // those that are finished
    void skip(std::size_t pixels);   // the first ones, of a new sweep
    void restart();                  // the same pixels again

private:
    void skipTiles();

    std::vector<std::uint32_t> counts_;
    std::size_t tile_ = 0;
    std::uint32_t pixel_ = 0;  // among the tile's
};

// How far --adaptive neighbours is.
struct AdaptiveProgress {
    std::uint32_t mean = 0, roundEnd = 0;    // samples per pixel on average after the last round, and after the one under way
    std::uint32_t commonEnd = 0;             // of the samples that all pixels share in this round
    std::uint32_t chosenBegin = 0;           // index of the first samples that pixels have besides
    bool choosing = false;                   // the round is at these
    bool second = false;                     // and at those of the second half
    std::vector<std::uint32_t> chosen;       // how many samples each pixel has besides, and
    std::vector<std::uint32_t> blocksLeft;   // how many blocks it is still to get in this round,
    std::vector<std::uint32_t> blocksLater;  // and how many for the second half behind them, if halves are kept and it is at the first
};

// What has been taken, in whole blocks. A plan goes on from it as if it had never stopped.
struct SampleProgress {
    std::uint32_t sample = 0;       // the first one that some pixel lacks; begins a block
    std::uint32_t pixelsAhead = 0;  // so many pixels, from the first on, have this block too
    std::uint32_t lightSample = 0;  // the first one whose light paths are missing
    std::optional<AdaptiveProgress> adaptive;

    // Sets the sample ranges and the completeness of a film that has these samples from `begin` on.
    void describe(Film& film, std::uint32_t begin) const;
};

inline bool isChoosing(const SampleProgress& progress) { return progress.adaptive && progress.adaptive->choosing; }

// What a plan asks for between passes.
enum class PlanTask {
    ChooseAllPixels,  // of all tiles
    ChoosePixels,     // those of SamplePlan::sweep()
    TestPixels,       // choose those that the course's rule has not stopped; SamplePlan::choose() takes their numbers
    TakeHalves,       // FilmHalves, if they are wanted
    TakeFirstHalf,    // of the chosen pixels' samples,
    TakeSecondHalf,   // and the second one
    FoldCommon,       // the samples that all pixels share, into the film and into the one that allocation is based on
    Allocate,         // SamplePlan::allocate() takes the shares
    Fold,             // all samples so far into the film
};

class SamplePlan {
public:
    // `tracesLight`: light paths are traced too.
    SamplePlan(const RenderSettings& settings, bool tracesLight);

    // Goes on from another one's progress, if it can.
    bool canResume(const SampleProgress& progress) const;
    void resume(SampleProgress progress, std::uint32_t paths);
    // Nothing before the first block, within one of an adaptive render, and if the adaptive rule is the course's. Halves are of whole
    // blocks, so no pixel is ahead if they are kept, but for chosen ones.
    std::optional<SampleProgress> progress() const;

    // A picture is rendered by: rounds, as long as beginRound() begins one, each with its tasks; then a light pass, or else a pass and its
    // tasks; and so on until isDone().
    bool beginRound();
    std::optional<PlanTask> takeTask();
    std::optional<LightPass> nextLight(std::uint32_t paths) const;
    CameraPass next(std::uint32_t paths) const;
    void finish(const LightPass& pass) { lightSample_ += pass.sampleCount; }
    void finish(const CameraPass& pass, std::uint32_t paths);
    bool isDone() const { return chosen_ == 0 || (isNeighbours(settings_.adaptive) ? mean_ : sample_) == settings_.sampleEnd; }

    // Answers to tasks: the chosen pixels of each tile, and each pixel's share of a round's samples (allocate_samples.hpp). halves: those
    // that are kept, which its blocks go to one after the other; or null.
    void choose(std::vector<std::uint32_t> counts);
    void allocate(const std::vector<double>& shares, const FilmHalves* halves, std::uint32_t paths);
    const std::vector<PixelStart>& sweep() const { return sweep_.pixels; }
    // The half that the samples of chosen pixels go to, while these are taken.
    std::optional<std::size_t> chosenHalf() const { return choosing_ ? std::optional<std::size_t>(second_ ? 1 : 0) : std::nullopt; }

    // The stopping rule. To be asked before the first pass: how many samples a picture with a target takes is known only later.
    void expectTarget();
    // Whether the error should be judged now: at ends of blocks or rounds, once each.
    bool isJudgedNow() const;
    // By what factor the samples so far must still grow. Returns whether they need not.
    bool judge(double timesToTarget);

    // Samples per chosen pixel (with --adaptive neighbours the mean over all pixels).
    std::uint32_t sampleCount() const { return mean_ > 0 ? mean_ : sample_ - settings_.sampleBegin; }
    // Samples of all pixels together: taken, and expected at the end if no further pixel ends early.
    std::uint64_t pictureSamples() const { return pictureSamples_; }
    std::uint64_t plannedSamples() const { return plannedSamples_; }
    std::uint64_t resumedSamples() const { return resumedSamples_; }  // of pictureSamples(), those before resume()
    // The first sample without light paths.
    std::uint32_t lightSample() const { return lightSample_; }
    // The first sample that some pixels lack and, within a sweep, the first that all lack.
    std::uint32_t endOfSamples() const { return sweeping_ && !choosing_ ? sweepEnd() : sample_; }
    // Sets the sample ranges and the completeness of a film that has all samples so far.
    void describe(Film& film) const;

private:
    std::vector<std::uint32_t> tileCounts() const;
    std::uint32_t sweepEnd() const;
    std::uint32_t lightEnd() const;
    bool isBetweenRounds() const { return mean_ == roundEnd_; }
    void endSweep(std::uint32_t paths);
    void startChosenSweep(std::uint32_t paths);

    RenderSettings settings_;
    bool tracesLight_;
    std::uint32_t sample_;       // first sample of the current sweep over all pixels
    std::uint32_t lightSample_;  // first sample without light paths
    bool sweeping_ = false;      // the sweep, or the round's chosen part, has had a pass
    SweepCursor cursor_;
    std::uint64_t chosen_;        // pixels that sweeps over all pixels go over
    std::uint32_t aheadEnd_ = 0;  // of the sweep that a checkpoint had begun
    std::deque<PlanTask> tasks_;

    std::uint64_t pictureSamples_ = 0, resumedSamples_ = 0, plannedSamples_;
    std::uint64_t judgedSamples_ = 0;  // pictureSamples_ when the error was last judged
    double timesToTarget_ = std::numeric_limits<double>::infinity();

    // For --adaptive neighbours.
    std::uint32_t mean_ = 0;                  // mean samples per pixel after the last round
    std::uint32_t roundEnd_ = 0;              // the same after the current round
    std::uint32_t commonEnd_ = 0;             // number of samples that all pixels share, at the end of the current round
    BlockQueue chosenBlocks_;                 // the samples of chosen pixels
    std::vector<std::uint32_t> laterBlocks_;  // of each pixel, for the second half, while the first one has its turn
    bool second_ = false;                     // the second half has its turn
    bool choosing_ = false;                   // the current sweep is over chosen pixels
    Sweep sweep_;                             // that one
};

// How many of `pixels`, in ascending order, each tile has.
std::vector<std::uint32_t> countByTile(const std::vector<PixelStart>& pixels, const RenderSettings& settings);

// The end of the block that begins with this sample.
std::uint32_t blockEnd(std::uint32_t sample);
inline bool endsBlock(std::uint32_t end) { return end > 0 && end % blockSamples(end - 1) == 0; }

}  // namespace glim
