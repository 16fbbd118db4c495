#include "host/bench/run_bench.hpp"

#include "host/bench/measure_error.hpp"

#include <algorithm>
#include <bit>

namespace glim {
namespace {

// Of a seed no bench begins with: what a pilot finds is thrown away.
constexpr std::uint32_t kPilotSeed = 0xb0000000U;
constexpr double kPilotShare = 0.25;  // of the seconds, from which the whole is foretold

// Until every pixel has `samples` of them. Seconds that took; nothing if `goesOn` ended it.
std::optional<double> sampleUntil(Renderer& renderer, std::uint32_t samples, const std::function<bool()>& goesOn)
{
    const auto start = std::chrono::steady_clock::now();
    while (renderer.sampleCount() < samples) {
        if (!renderer.advance(goesOn)) {
            return std::nullopt;
        }
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// One seed: adds its entry to every point, and returns the terms of the last one's error; nothing if `goesOn` ended it.
std::optional<std::vector<float>> renderSeed(Renderer& renderer, const Picture& reference, std::vector<BenchPoint>& points,
                                             const std::function<bool()>& goesOn)
{
    double seconds = 0.0;
    const double kernelStart = renderer.statistics().passSeconds;
    PictureError error;
    for (BenchPoint& point : points) {
        const auto taken = sampleUntil(renderer, point.samples, goesOn);
        if (!taken) {
            return std::nullopt;
        }
        seconds += *taken;
        error = measureError(pictureOf(renderer.film()), reference);
        point.seconds.push_back(seconds);
        point.kernelSeconds.push_back(renderer.statistics().passSeconds - kernelStart);
        point.mean.push_back(error.mean);
        point.mse.push_back(error.mse);
        point.relMse.push_back(error.relMse);
        point.trimmedRelMse.push_back(error.trimmedRelMse);
    }
    return std::move(error.terms);
}

}  // namespace

std::optional<std::uint32_t> chooseSamples(Renderer& renderer, const FlatCamera& camera, double seconds, std::uint32_t most,
                                           const BenchObserver& observer)
{
    const auto goesOn = [&] { return observer(0); };
    renderer.restart(camera, kPilotSeed);
    std::uint32_t samples = 8;
    if (!sampleUntil(renderer, samples, goesOn)) {
        return std::nullopt;
    }
    double each = 0.0;
    do {
        const auto taken = sampleUntil(renderer, 2 * samples, goesOn);
        if (!taken) {
            return std::nullopt;
        }
        each = *taken / samples;
        samples *= 2;
    } while (each * samples < kPilotShare * seconds && samples < most);
    const std::uint32_t least = renderer.settings().adaptive == Adaptive::Off ? kLeastBenchSamples : 2 * kPilotSamples;
    const double fitting = std::clamp(seconds / each, static_cast<double>(least), static_cast<double>(most));
    return std::bit_floor(static_cast<std::uint32_t>(fitting));
}

std::optional<RenderedSeeds> renderSeeds(Renderer& renderer, const FlatCamera& camera, const std::vector<std::uint32_t>& seeds,
                                         std::uint32_t samples, const Picture& reference, const BenchObserver& observer)
{
    RenderedSeeds rendered;
    for (std::uint32_t count = 1; count <= samples; count *= 2) {
        rendered.points.push_back({count, {}, {}, {}, {}, {}, {}});
    }
    std::vector<std::vector<float>> terms;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        renderer.restart(camera, seeds[i]);
        auto last = renderSeed(renderer, reference, rendered.points,
                               [&] { return observer(std::uint64_t{samples} * i + renderer.sampleCount()); });
        if (!last) {
            return std::nullopt;
        }
        terms.push_back(std::move(*last));
    }
    rendered.bias = estimateBias(terms, measureFloor(reference));
    return rendered;
}

}  // namespace glim
