// glim's own denoiser: non-local means that knows the noise of every pixel (shaders/lib/nl_means.glsl). It looks at radiance and variance
// alone, and gives the same bits on every device.
#pragma once

#include "host/gpu/commands.hpp"
#include "host/render/film.hpp"
#include "shaders/shared/denoise_types.h"

#include <functional>
#include <optional>
#include <vector>

namespace glim {

class NlMeans {
public:
    explicit NlMeans(Device& device);

    // The denoised radiance of each pixel. The film has its variance, which takes two blocks of samples; a pixel of fewer counts as
    // unknown. Returns nothing if `shouldContinue`, asked several times a second, ended it.
    std::optional<std::vector<glm::vec3>> denoise(const Film& film, const std::function<bool()>& shouldContinue);

private:
    struct Band;
    // `count` threads of a kernel, in dispatches of about a twentieth of a second.
    bool run(const Kernel& kernel, const Bindings& bindings, DenoisePass pass, std::uint32_t count,
             const std::function<bool()>& shouldContinue);
    std::optional<std::vector<WeightedSum>> sumWindows(const Band& band, const std::vector<NoisyPixel>& noisy,
                                                       const std::function<bool()>& shouldContinue);

    Device& device_;
    KernelLayout layout_;
    Kernel pool_, compare_, weigh_;
    std::map<const Kernel*, std::uint32_t> threads_;  // of a dispatch
};

}  // namespace glim
