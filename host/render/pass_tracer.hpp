// Traces the paths of passes to their end: dispatches the kernels in their order.
#pragma once

#include "host/render/pass_size.hpp"
#include "host/render/render_resources.hpp"

namespace glim {

// What is recorded of a pass.
struct PassProgress {
    Pass pass;                 // its next bounce and round
    bool addsSamples;          // to the film
    std::uint32_t firstRound;  // of the pass
    std::uint32_t from;        // the first bounce of those recorded last, and
    std::uint32_t alive;       // its paths
};

// A pass that the device traces while the host goes on.
struct StartedPass {
    Recording recording;
    const Tile& tile;
    PassProgress progress;
};

class PassTracer {
public:
    explicit PassTracer(RenderResources& resources)
        : resources_(resources)
    {}

    // Traces the pass and adds its samples to the film. Returns the time it took. Returns nothing, and leaves the film as it was, if
    // `shouldContinue`, asked after each portion of dispatches, ended it.
    std::optional<PassSeconds> trace(const Tile& tile, const Pass& pass, const std::function<bool()>& shouldContinue);
    // The same without adding them, by a recording that may watch the kernels.
    void tracePaths(Recording& recording, const Tile& tile, const Pass& pass);

    // Whether a pass may be started while the device traces the one before: passes are so short that nobody need be asked within one.
    bool startsAhead() const;
    // Lets the device trace the pass, once the one before has ended.
    std::unique_ptr<StartedPass> start(const Tile& tile, const Pass& pass);
    // Waits until the film has the pass's samples. If the pass was late, since its paths met more surfaces than those of the passes
    // before, then the device has left out the pass that was started after it.
    struct Ended {
        PassSeconds seconds;
        bool wasLate;
    };
    Ended end(StartedPass& started);

    // Traces `count` light paths from number `first` on, counted from the first of sample `firstSample`, and adds what they bring to the
    // band's pixels to the splats of its pass. Returns nothing if `shouldContinue` ended it; these are then of no use.
    std::optional<PassSeconds> traceLight(const SplatBuffer::Band& band, std::uint32_t firstSample, std::uint32_t first,
                                          std::uint32_t count, const std::function<bool()>& shouldContinue);
    // Moves the splats of the pass to the block.
    void addSplats(const SplatBuffer& splats);
    // Folds the open blocks of all pixels, chosen or not, into their pages.
    void closeBlocks(const Tile& tile);
    // Chooses the pixels that have `samples` samples and still need some. Returns how many these are.
    std::uint32_t choosePixels(Tile& tile, std::uint32_t samples);

private:
    PassProgress begin(Recording& recording, const Tile& tile, Pass pass, bool addsSamples) const;
    bool finish(Recording& recording, const Tile& tile, PassProgress& progress) const;
    std::uint32_t pathsOf(const Pass& pass) const;
    bool isOver(PassProgress& progress) const;
    void recordRounds(Recording& recording, const Tile& tile, PassProgress& progress, std::uint32_t count) const;
    void recordRound(Recording& recording, const Bindings& bindings, const Pass& pass) const;
    void recordEnd(Recording& recording, const Tile& tile, const Pass& pass) const;
    void writeRounds(Recording& recording, std::uint32_t first, std::uint32_t paths, std::uint32_t share) const;
    PassSeconds secondsOf(const Recording& recording) const;
    std::uint32_t portion() const;
    std::uint32_t pathsPerThread() const { return rulesOf(resources_.device.description().deviceClass).pathsPerThread; }
    bool isPersistent() const { return kernels().ofPaths().has_value(); }
    std::uint32_t lastBounce() const { return isPersistent() || resources_.scatters ? ~0U : pathLengths(resources_.settings).maxBounces; }
    const KernelSet& kernels() const { return resources_.kernels(); }

    RenderResources& resources_;
};

}  // namespace glim
