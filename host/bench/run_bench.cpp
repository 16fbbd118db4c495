#include "host/bench/run_bench.hpp"

#include "host/clock.hpp"
#include "host/measure/compare_images.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <numeric>

namespace glim {
namespace {

std::vector<float> errorTerms(const Picture& picture, const Picture& reference, double epsilon)
{
    std::vector<float> terms(3 * picture.radiance.size(), 0.0F);
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        if (isFinite(picture.radiance[i]) && isFinite(reference.radiance[i])) {
            for (int c = 0; c < 3; ++c) {
                const double r = static_cast<double>(reference.radiance[i][c]);
                const double difference = static_cast<double>(picture.radiance[i][c]) - r;
                const double scale = std::sqrt(r * r + epsilon);
                terms[3 * i + static_cast<std::size_t>(c)] = difference != 0.0 ? static_cast<float>(difference / scale) : 0.0F;
            }
        }
    }
    return terms;
}

double product(const std::vector<float>& a, const std::vector<float>& b, std::size_t begin, std::size_t end)
{
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    }
    return sum;
}

// A seed that no bench begins with: the pilot's samples are thrown away.
constexpr std::uint32_t kPilotSeed = 0xb0000000U;
constexpr double kPilotShare = 0.25;  // of the seconds; the rest is extrapolated from it

// Of all threads, those of a software device included.
double cpuSecondsOfProcess() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Samples until every pixel has `samples`. Returns the seconds it took, or nothing if `shouldContinue` ended it.
std::optional<double> sampleUntil(Renderer& renderer, std::uint32_t samples, const std::function<bool()>& shouldContinue)
{
    const auto start = Clock::now();
    while (renderer.plan().sampleCount() < samples) {
        if (!renderer.advance(shouldContinue)) {
            return std::nullopt;
        }
    }
    return secondsSince(start);
}

// Renders one seed and adds its entry to every point. Returns the terms of the last point's error, or nothing if `shouldContinue`
// ended it.
std::optional<std::vector<float>> renderSeed(Renderer& renderer, const Picture& reference, std::vector<BenchPoint>& points,
                                             const std::function<bool()>& shouldContinue)
{
    double seconds = 0.0, cpuSeconds = 0.0;
    const double kernelStart = renderer.statistics().passSeconds;
    PictureError error;
    for (BenchPoint& point : points) {
        const double cpuStart = cpuSecondsOfProcess();
        const auto taken = sampleUntil(renderer, point.samples, shouldContinue);
        if (!taken) {
            return std::nullopt;
        }
        seconds += *taken;
        cpuSeconds += cpuSecondsOfProcess() - cpuStart;
        error = measureError(makePicture(renderer.film()), reference);
        point.seconds.push_back(seconds);
        point.cpuSeconds.push_back(cpuSeconds);
        point.kernelSeconds.push_back(renderer.statistics().passSeconds - kernelStart);
        point.mean.push_back(error.mean);
        point.mse.push_back(error.mse);
        point.relMse.push_back(error.relMse);
        point.trimmedRelMse.push_back(error.trimmedRelMse);
    }
    return std::move(error.terms);
}

}  // namespace

PictureError measureError(const Picture& picture, const Picture& reference)
{
    const Comparison comparison = compareImages(picture, reference);
    return {meanRadiance(picture), comparison.errors.mse, comparison.errors.relMse, comparison.trimmed.kept.relMse,
            errorTerms(picture, reference, comparison.epsilon)};
}

// The error of the floor is that of a sum of squared normal variables; a pixel's three channels count as one.
Floor measureFloor(const Picture& reference)
{
    const auto noise = estimateReferenceNoise(reference);
    if (!noise) {
        return {};
    }
    Picture shifted = reference;  // by one standard deviation: its terms squared are the variances
    for (std::size_t i = 0; i < shifted.radiance.size(); ++i) {
        shifted.radiance[i] += glm::sqrt(isFinite(reference.variance[i]) ? reference.variance[i] : glm::vec3(0.0F));
    }
    const std::vector<float> terms = errorTerms(shifted, reference, compareImages(shifted, reference).epsilon);
    double squares = 0.0;
    for (std::size_t i = 0; i < terms.size(); i += 3) {
        const double pixel = product(terms, terms, i, i + 3);
        squares += pixel * pixel;
    }
    return {noise->mse, noise->relMse, std::sqrt(2.0 * squares) / static_cast<double>(terms.size()), true};
}

Bias estimateBias(const std::vector<std::vector<float>>& terms, const Floor& floor)
{
    const std::size_t count = terms.size();
    std::vector<double> rows(count, 0.0);  // sums of the products with all others
    for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const double mean = product(terms[a], terms[b], 0, terms[a].size()) / static_cast<double>(terms[a].size());
            rows[a] += mean;
            rows[b] += mean;
        }
    }
    const double n = static_cast<double>(count), total = std::accumulate(rows.begin(), rows.end(), 0.0);
    const double mean = total / (n * (n - 1.0));
    double squares = 0.0;
    for (const double row : rows) {
        const double without = (total - 2.0 * row) / ((n - 1.0) * (n - 2.0));
        squares += (without - mean) * (without - mean);
    }
    const double jackknife = (n - 1.0) / n * squares;
    return {mean - floor.relMse, std::sqrt(jackknife + floor.relMseError * floor.relMseError)};
}

std::optional<std::uint32_t> chooseSamples(Renderer& renderer, const FlatCamera& camera, double seconds, std::uint32_t most,
                                           const BenchObserver& observer)
{
    const auto shouldContinue = [&] { return observer(0); };
    renderer.restart(camera, kPilotSeed);
    std::uint32_t samples = 8;
    if (!sampleUntil(renderer, samples, shouldContinue)) {
        return std::nullopt;
    }
    double each = 0.0;
    do {
        const auto taken = sampleUntil(renderer, 2 * samples, shouldContinue);
        if (!taken) {
            return std::nullopt;
        }
        each = *taken / samples;
        samples *= 2;
    } while (each * samples < kPilotShare * seconds && samples < most);
    const std::uint32_t least = renderer.settings().adaptive == Adaptive::Off ? kMinBenchSamples : 2 * kPilotSamples;
    const double fitting = std::clamp(seconds / each, static_cast<double>(least), static_cast<double>(most));
    return std::bit_floor(static_cast<std::uint32_t>(fitting));
}

std::optional<std::vector<RenderedSeeds>> renderSeeds(const std::vector<BenchSide>& sides, const std::vector<std::uint32_t>& seeds,
                                                      std::uint32_t samples, const Picture& reference, const BenchObserver& observer)
{
    std::vector<RenderedSeeds> rendered(sides.size());
    for (RenderedSeeds& side : rendered) {
        for (std::uint32_t count = 1; count <= samples; count *= 2) {
            side.points.push_back({count, {}, {}, {}, {}, {}, {}, {}});
        }
    }
    std::vector<std::vector<std::vector<float>>> terms(sides.size());
    for (std::size_t i = 0; i < seeds.size() * sides.size(); ++i) {
        const std::size_t round = i / sides.size(), at = (i + round) % sides.size();
        const auto& [renderer, camera] = sides[at];
        renderer.restart(camera, seeds[round]);
        auto last = renderSeed(renderer, reference, rendered[at].points,
                               [&, &renderer = renderer] { return observer(std::uint64_t{samples} * i + renderer.plan().sampleCount()); });
        if (!last) {
            return std::nullopt;
        }
        terms[at].push_back(std::move(*last));
    }
    const Floor floor = measureFloor(reference);
    for (std::size_t side = 0; side < sides.size(); ++side) {
        rendered[side].bias = estimateBias(terms[side], floor);
    }
    return rendered;
}

}  // namespace glim
