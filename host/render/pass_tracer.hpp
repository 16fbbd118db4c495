// Traces the paths of passes to their end: dispatches the kernels in their order.
#pragma once

#include "host/render/pass_size.hpp"
#include "host/render/render_resources.hpp"

namespace glim {

class PassTracer {
public:
    explicit PassTracer(RenderResources& resources)
        : resources_(resources)
    {}

    // Traces the pass and adds its samples to the film. Returns the time it took. Returns nothing, and leaves the film as it was, if
    // `shouldContinue`, asked after each portion of dispatches, ended it.
    std::optional<PassSeconds> trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue);
    // The same without adding them, by a recording that may watch the kernels.
    void tracePaths(Recording& recording, const Tile& tile, const Pass& pass);
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
    bool traceToEnd(Recording& recording, const Tile& tile, Pass pass, const std::function<void(const Pass&)>& recordEnd);
    void recordRounds(Recording& recording, std::uint32_t paths, std::uint32_t share) const;
    void recordRound(Recording& recording, const Bindings& bindings, const Pass& pass) const;
    void recordEnd(Recording& recording, const Tile& tile, const Pass& pass) const;
    std::uint32_t portion() const;
    const KernelSet& kernels() const { return resources_.kernels(); }

    RenderResources& resources_;
};

}  // namespace glim
