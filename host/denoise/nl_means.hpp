// glim's own denoiser: non-local means that knows the noise of every pixel (shaders/lib/nl_means.glsl). It looks at radiance and variance
// alone, and gives the same bits on every device.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/film.hpp"
#include "shaders/shared/denoise_types.h"

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace glim {

class NlMeans {
public:
    static constexpr const char* kName = "non-local means";

    explicit NlMeans(Device& device);

    // The denoised radiance of each pixel. The film has its variance, which takes two blocks of samples; a pixel of fewer counts as
    // unknown. Returns nothing if `shouldContinue`, asked several times a second, ended it.
    std::optional<std::vector<glm::vec3>> denoise(const Film& film, const std::function<bool()>& shouldContinue);

    // The same in pieces.
    class Work {
    public:
        // `denoiser` must outlive it; the film is copied.
        Work(NlMeans& denoiser, const Film& film);
        // Goes on until all is done, or `shouldContinue` ends this piece. Returns whether all is done.
        bool advance(const std::function<bool()>& shouldContinue);
        // To be called once, when all is done.
        std::vector<glm::vec3> takeResult() { return std::move(result_); }

    private:
        struct Band;
        void openBand();
        bool runStep(const std::function<bool()>& shouldContinue);
        void closeBand();

        NlMeans& denoiser_;
        std::uint32_t width_, height_;
        float scale_;
        std::vector<NoisyPixel> noisy_;
        std::vector<glm::vec3> result_;  // of the bands that are done
        std::shared_ptr<Band> band_;     // under way, or null
        std::uint32_t step_ = 0;         // of the band: pools its variance, then compares and weighs one row of the windows after another
        std::uint32_t thread_ = 0;       // of the step, that comes next
    };

private:
    Device& device_;
    KernelLayout layout_;
    Kernel pool_, compare_, weigh_;
    std::map<const Kernel*, std::uint32_t> threads_;  // of a dispatch
};

}  // namespace glim
