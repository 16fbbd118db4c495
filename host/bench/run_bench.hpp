// Renders a picture from many seeds, and looks how far it is from the reference after 1, 2, 4 ... samples.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/measure/picture.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

// Six doublings, below which a slope says little.
inline constexpr std::uint32_t kLeastBenchSamples = 64;

// Is asked several times a second, with the samples that each pixel has had so far, of all seeds together; false ends the work.
using BenchObserver = std::function<bool(std::uint64_t samples)>;

// The power of two, from kLeastBenchSamples (of adaptive renders, twice kPilotSamples) to `most`, that takes about `seconds`. Measured
// after the costs of first dispatches, which are thereby paid. Nothing if `observer` ended it.
std::optional<std::uint32_t> chooseSamples(Renderer& renderer, const FlatCamera& camera, double seconds, std::uint32_t most,
                                           const BenchObserver& observer);

struct RenderedSeeds {
    std::vector<BenchPoint> points;
    Bias bias;
};

// Each of `seeds` to `samples`, a power of two within the renderer's sampleEnd. Nothing if `observer` ended it.
std::optional<RenderedSeeds> renderSeeds(Renderer& renderer, const FlatCamera& camera, const std::vector<std::uint32_t>& seeds,
                                         std::uint32_t samples, const Picture& reference, const BenchObserver& observer);

}  // namespace glim
