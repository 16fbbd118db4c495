#include "host/render/light_passes.hpp"

#include <algorithm>

namespace glim {

std::optional<PassSeconds> LightPasses::trace(PassTracer& tracer, const SplatBuffer& splats, const LightPass& pass,
                                              const std::function<bool()>& shouldContinue)
{
    const std::uint32_t all = pass.sampleCount * lightPathCount(settings_.width, settings_.height);
    PassSeconds sum{0.0, 0.0};
    for (const auto& band : splats.bands()) {
        for (std::uint32_t first = 0; first < all;) {
            const std::uint32_t count = std::min(all - first, size_.paths());
            const auto seconds = tracer.traceLight(*band, pass.firstSample, first, count, shouldContinue);
            if (!seconds) {
                splats.emptyPass();
                return std::nullopt;
            }
            sum = {std::max(sum.longest, seconds->longest), sum.total + seconds->total};
            size_.learn(count, *seconds);
            first += count;
        }
    }
    tracer.addSplats(splats);
    return sum;
}

}  // namespace glim
