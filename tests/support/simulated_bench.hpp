// Benches of pictures whose samples are random numbers, as of a renderer with a known flaw or without one.
#pragma once

#include "host/bench/run_bench.hpp"
#include "tests/harness/random.hpp"

#include <cmath>
#include <numeric>

namespace glim::test {

enum class Flaw { None, Bias, RepeatsAfter16, SameInEverySeed };

inline constexpr std::uint32_t kBenchSide = 16, kBenchSamples = 64, kBenchSeeds = 16, kReferenceSamples = 8192;

// Exponential numbers, of mean 1 and variance 1: about as skewed as the light of a plain pixel.
inline float drawSample(Random& random) { return static_cast<float>(-std::log(1.0 - random.uniform())); }

inline Picture simulateReference(std::uint64_t seed)
{
    Random random(seed);
    const float variance = 1.0F / kReferenceSamples;
    Picture reference{kBenchSide, kBenchSide, {}, {}};
    for (std::uint32_t i = 0; i < kBenchSide * kBenchSide; ++i) {
        const glm::vec3 noise(random.normalVector());
        reference.radiance.push_back(glm::vec3(1.0F) + std::sqrt(variance) * noise);
        reference.variance.emplace_back(variance);
    }
    return reference;
}

// Running means of `samples` samples, one picture for each power of two.
inline std::vector<Picture> simulateSeed(Flaw flaw, std::uint64_t seed)
{
    Random random(seed);
    std::vector<glm::vec3> sums(kBenchSide * kBenchSide, glm::vec3(0.0F));
    std::vector<std::vector<glm::vec3>> drawn;
    std::vector<Picture> pictures;
    for (std::uint32_t sample = 0; sample < kBenchSamples; ++sample) {
        if (flaw != Flaw::RepeatsAfter16 || sample < 16) {
            drawn.emplace_back();
            for (std::size_t i = 0; i < sums.size(); ++i) {
                const float r = drawSample(random), g = drawSample(random);
                drawn.back().push_back(glm::vec3(r, g, drawSample(random)) * (flaw == Flaw::Bias ? 1.1F : 1.0F));
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            sums[i] += drawn[sample % drawn.size()][i];
        }
        const std::uint32_t count = sample + 1;
        if ((count & sample) == 0) {
            pictures.push_back({kBenchSide, kBenchSide, {}, {}});
            for (const glm::vec3& sum : sums) {
                pictures.back().radiance.push_back(sum / static_cast<float>(count));
            }
        }
    }
    return pictures;
}

// `trial` tells one bench's random numbers from another's. A sample takes a microsecond, give or take 5 %.
inline SceneBench simulateBench(Flaw flaw, std::uint64_t trial)
{
    SceneBench bench;
    bench.scene = "scenes/\"noise\".gltf";
    bench.settings = "seed=0 bounces=64";
    bench.width = bench.height = kBenchSide;
    bench.seeds.resize(kBenchSeeds);
    std::iota(bench.seeds.begin(), bench.seeds.end(), 0U);
    const Picture reference = simulateReference(1000 * trial + 999);
    bench.floor = measureFloor(reference);
    std::vector<std::vector<float>> terms;
    for (const std::uint32_t seed : bench.seeds) {
        const std::vector<Picture> pictures = simulateSeed(flaw, 1000 * trial + (flaw == Flaw::SameInEverySeed ? 0 : seed));
        bench.points.resize(pictures.size());
        Random clock(1000 * trial + 500 + seed);
        const double each = 1e-6 * kBenchSide * kBenchSide * (1.0 + 0.05 * clock.normal());
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            BenchPoint& point = bench.points[i];
            point.samples = 1U << i;
            PictureError error = measureError(pictures[i], reference);
            point.seconds.push_back(each * point.samples);
            point.cpuSeconds.push_back(1.8 * each * point.samples);
            point.kernelSeconds.push_back(0.9 * each * point.samples);
            point.mse.push_back(error.mse);
            point.relMse.push_back(error.relMse);
            point.mean.push_back(error.mean);
            point.trimmedRelMse.push_back(error.trimmedRelMse);
            if (i + 1 == pictures.size()) {
                terms.push_back(std::move(error.terms));
            }
        }
    }
    bench.bias = estimateBias(terms, bench.floor);
    return bench;
}

}  // namespace glim::test
