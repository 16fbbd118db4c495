// The noise of a small picture, by which two ways to find a scene's light are compared.
#pragma once

#include "host/render/renderer.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace glim {

struct Noise {
    // Of a sample, relative to the radiance around its pixel. It is the square of the mean of standard deviations, since a mean of
    // variances would be that of the few pixels with fireflies.
    double variance = 0.0;
    double rays = 0.0;  // of a sample

    // What makes a picture take long: samples for an error, and rays for a sample.
    double work() const { return variance * rays; }
};

// Measures pictures of about 1024 pixels, with samples that no film has: what a film's samples have met chooses no guide of theirs.
class NoiseMeter {
public:
    // Shares the resources of `base`, a renderer of the scene that is idle while this one measures. `settings`: of the film.
    NoiseMeter(const Renderer& base, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Of paths by `guide`; null: by none. Nothing if `shouldContinue`, asked when the device is idle, has ended it.
    std::optional<Noise> measure(std::shared_ptr<const Guide> guide, const std::function<bool()>& shouldContinue);

private:
    const Renderer& base_;
    const FlatScene& scene_;
    const FlatCamera& camera_;
    RenderSettings settings_;
    std::unique_ptr<Renderer> guided_;  // the last one, for its kernels
};

}  // namespace glim
