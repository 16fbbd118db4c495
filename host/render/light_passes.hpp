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
    void begin(const RenderSettings& settings) { settings_ = settings; }
    std::uint32_t paths() const { return size_.paths(); }
    // Adds the light that a pass brings to the block of `splats`. Returns the time that it took; nothing if `shouldContinue` ended it, and
    // then nothing is added.
    std::optional<PassSeconds> trace(PassTracer& tracer, const SplatBuffer& splats, const LightPass& pass,
                                     const std::function<bool()>& shouldContinue);

private:
    PassSize size_;
    RenderSettings settings_;
};

}  // namespace glim
