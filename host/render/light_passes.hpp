// Passes of light paths, for caustics.
#pragma once

#include "host/render/pass_tracer.hpp"
#include "host/render/sample_plan.hpp"

namespace glim {

class LightPasses {
public:
    // For scenes and settings that tracesLight() is true of.
    LightPasses(const FlatScene& scene, const RenderSettings& settings, std::uint32_t capacity)
        : size_(scene, settings, capacity)
    {}

    // Starts a picture.
    void begin(const RenderResources& resources, const RenderSettings& settings);
    std::uint32_t paths() const { return size_.paths(); }
    // The light that a pass brings to each pixel of the film, and the time that it took; nothing if `shouldContinue` ended it.
    struct Traced {
        std::vector<Splat> splats;
        PassSeconds seconds{0.0, 0.0};
    };
    std::optional<Traced> trace(PassTracer& tracer, const LightPass& pass, const std::function<bool()>& shouldContinue);

private:
    PassSize size_;
    RenderSettings settings_;
    std::unique_ptr<SplatBuffer> splats_;
};

}  // namespace glim
