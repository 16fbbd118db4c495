#include "host/render/light_passes.hpp"

#include <algorithm>

namespace glim {

void LightPasses::begin(const RenderResources& resources, const RenderSettings& settings)
{
    settings_ = settings;
    splats_ = resources.makeSplatBuffer(SplatBuffer::countFor(settings));
}

std::optional<LightPasses::Traced> LightPasses::trace(PassTracer& tracer, const LightPass& pass,
                                                      const std::function<bool()>& shouldContinue)
{
    const std::uint32_t all = pass.sampleCount * lightPathCount(settings_.width, settings_.height), pixels = settings_.pixelCount();
    Traced traced;
    for (std::uint32_t pixel = 0; pixel < pixels; pixel += splats_->count()) {
        splats_->clear();
        for (std::uint32_t first = 0; first < all;) {
            const std::uint32_t count = std::min(all - first, size_.paths());
            const auto seconds =
                tracer.traceLight(*splats_, settings_.firstPixel() + pixel, pass.firstSample, first, count, shouldContinue);
            if (!seconds) {
                return std::nullopt;
            }
            traced.seconds = {std::max(traced.seconds.longest, seconds->longest), traced.seconds.total + seconds->total};
            size_.learn(count, *seconds);
            first += count;
        }
        const std::vector<Splat> band = splats_->read(std::min(splats_->count(), pixels - pixel));
        traced.splats.insert(traced.splats.end(), band.begin(), band.end());
    }
    return traced;
}

}  // namespace glim
