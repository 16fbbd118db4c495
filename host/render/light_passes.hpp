// Passes of light paths, for caustics: which samples of the picture have theirs, and the light that they have brought.
#pragma once

#include "host/render/wavefront.hpp"

namespace glim {

class LightPasses {
public:
    // For scenes and settings that tracesLight() is true of.
    LightPasses(const FlatScene& scene, const RenderSettings& settings);

    // Starts a picture.
    void begin(Wavefront& wavefront, const RenderSettings& settings);
    // The first sample that has no light paths yet.
    std::uint32_t sample() const { return sample_; }
    // Traces those of some samples before `end`, all of one block. Returns the time that it took; nothing if `shouldContinue` ended it, and
    // the samples then have none.
    std::optional<PassSeconds> trace(Wavefront& wavefront, std::uint32_t end, const std::function<bool()>& shouldContinue);

    // Closes the open block, whole or not, and folds the light so far into `film`.
    void foldInto(std::vector<SplatMoments>& film) { sums_->foldInto(film); }
    // What foldInto would give; sampling may go on.
    void copyInto(std::vector<SplatMoments>& film) const { SplatSums(*sums_).foldInto(film); }

    // The light of finished blocks that is not folded, and the first sample that it lacks.
    const std::vector<SplatMoments>& page() const { return sums_->page(); }
    std::uint32_t finishedSample() const { return sample_ - sums_->openSamples(); }
    void resume(std::uint32_t finishedSample, std::vector<SplatMoments> page);

private:
    PassSize size_;
    float scale_;
    std::uint32_t paths_ = 0;                        // of a sample
    std::uint32_t firstPixel_ = 0, pixelCount_ = 0;  // of the film
    std::unique_ptr<SplatBuffer> splats_;
    std::optional<SplatSums> sums_;
    std::uint32_t sample_ = 0;
};

}  // namespace glim
