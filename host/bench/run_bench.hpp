// Renders a picture from many seeds, and measures how far it is from the reference after 1, 2, 4 ... samples.
#pragma once

#include "host/bench/bench_record.hpp"
#include "host/measure/picture.hpp"
#include "host/render/renderer.hpp"

#include <optional>

namespace glim {

struct PictureError {
    double mean = 0.0;  // of the picture
    double mse = 0.0, relMse = 0.0, trimmedRelMse = 0.0;
    std::vector<float> terms;  // (x - r) / sqrt(r^2 + eps), 0 where either is not finite: relMse is their mean square
};

// Refuses (InputError) pictures of different sizes.
PictureError measureError(const Picture& picture, const Picture& reference);

// The floor from the reference's variance.
Floor measureFloor(const Picture& reference);

// From the `terms` of at least 3 independent renders.
Bias estimateBias(const std::vector<std::vector<float>>& terms, const Floor& floor);

// Six doublings; a slope over fewer says little.
inline constexpr std::uint32_t kMinBenchSamples = 64;

// Is called several times a second with the samples that each pixel has had so far, over all seeds; false ends the work.
using BenchObserver = std::function<bool(std::uint64_t samples)>;

// The power of two, from kMinBenchSamples (for adaptive renders, twice kPilotSamples) to `most`, that takes about `seconds`. Measured
// after the first dispatches, so that their costs are paid. Nothing if `observer` ended it.
std::optional<std::uint32_t> chooseSamples(Renderer& renderer, const FlatCamera& camera, double seconds, std::uint32_t most,
                                           const BenchObserver& observer);

struct RenderedSeeds {
    std::vector<BenchPoint> points;
    Bias bias;
};

struct BenchSide {
    Renderer& renderer;
    const FlatCamera& camera;
};

// Renders each of `seeds` to `samples`, a power of two within the renderers' sampleEnd. Several sides take turns, a seed each, and the one
// that begins changes: what comes and goes on the machine meets all of them. Nothing if `observer` ended it.
std::optional<std::vector<RenderedSeeds>> renderSeeds(const std::vector<BenchSide>& sides, const std::vector<std::uint32_t>& seeds,
                                                      std::uint32_t samples, const Picture& reference, const BenchObserver& observer);

}  // namespace glim
