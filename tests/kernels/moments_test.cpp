#include "host/render/film.hpp"
#include "shaders/shared/limits.h"
#include "shaders/shared/path_types.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>

namespace glim::moments_test {

constexpr int kBlocks = 8;

struct Case {
    BlockSums blocks[kBlocks];
    PixelMoments expected;
    CatcherSums catchers[kBlocks]{};
    CatcherMoments expectedCatcher{};
};

BlockSums sumOf(const std::function<float()>& sample, std::uint32_t count)
{
    BlockSums sums{};
    sums.depth = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 0; i < count; ++i) {
        const float x = sample();
        ++sums.count;
        sums.radiance += vec3(x, 2.0F * x, 0.1F);
        sums.alpha += 1.0F;
        sums.albedo += vec3(0.5F * x);
        sums.normal += vec3(0.0F, x, 0.0F);
        sums.depth = std::min(sums.depth, x);
        sums.clamped += 0.25F * x;
    }
    return sums;
}

// A block of a catcher: samples that met it first, and the light of some.
CatcherMoments momentsOf(const CatcherSums& sums, std::uint32_t count)
{
    const float share = count > 0 ? 1.0F / static_cast<float>(count) : 0.0F;
    return {count, sums.share * share, sums.with * share, sums.without * share, vec3(0.0F)};
}

PixelMoments momentsOf(const BlockSums& sums)
{
    if (sums.count == 0) {
        return {};
    }
    const float share = 1.0F / static_cast<float>(sums.count);
    return {sums.count,          1,          sums.radiance * share, vec3(0.0F), sums.alpha * share, sums.albedo * share,
            sums.normal * share, sums.depth, sums.clamped * share};
}

// Blocks, some short or empty: the device's fold has the bits of the host's, on which exact merging rests.
TEST(MomentsTest, DeviceAndHostFoldToTheSameBits)
{
    std::mt19937 random(11);
    std::lognormal_distribution<float> value(0.0F, 2.0F);
    std::vector<Case> cases(512);
    for (Case& c : cases) {
        PixelMoments folded{};
        for (BlockSums& block : c.blocks) {
            const std::uint32_t count = random() % 4 == 0 ? random() % kBlockSamples : kBlockSamples;
            block = sumOf([&] { return value(random); }, count);
            folded = foldMoments(folded, momentsOf(block));
        }
        c.expected = folded;
        for (int i = 0; i < kBlocks; ++i) {
            c.catchers[i].share = static_cast<float>(c.blocks[i].count / 2);
            c.catchers[i].with = c.blocks[i].radiance;
            c.catchers[i].without = vec3(3.0F, 2.0F, 1.0F) * c.blocks[i].radiance + value(random);
            c.expectedCatcher = foldMoments(c.expectedCatcher, momentsOf(c.catchers[i], c.blocks[i].count));
        }
    }
    KernelTest(test_kernels::moments_test).cases(cases).run();
}

// H26: samples that ruin plain sums, added in blocks and folds. The mean is within 1e-5, the variance of the blocks within 1e-4
// of double arithmetic on the same samples.
TEST(MomentsTest, H26LongStreamsAreAccurate)
{
    std::mt19937 random(5);
    std::normal_distribution<float> gauss;
    std::lognormal_distribution<float> lognormal(0.0F, 1.0F);
    const std::vector<std::pair<const char*, std::function<float()>>> streams = {
        {"constant .1", [] { return 0.1F; }},
        {"1 + .001 N", [&] { return 1.0F + 0.001F * gauss(random); }},
        {"1e4 (1 + .01 N)", [&] { return 1e4F * (1.0F + 0.01F * gauss(random)); }},
        {"lognormal", [&] { return lognormal(random); }}};
    for (const auto& [name, stream] : streams) {
        const int blocks = 1 << 14;  // 1e6 samples
        PixelMoments film{};
        double mean = 0.0, squares = 0.0;
        for (int b = 1; b <= blocks; ++b) {
            double sum = 0.0;
            film = foldMoments(film, momentsOf(sumOf(
                                         [&, &stream_ = stream] {
                                             const float x = stream_();
                                             sum += static_cast<double>(x);
                                             return x;
                                         },
                                         kBlockSamples)));
            const double delta = sum / kBlockSamples - mean;
            mean += delta / b;
            squares += kBlockSamples * delta * (sum / kBlockSamples - mean);
        }
        std::printf("H26 %s: mean off by %.1e, squares %.4g against %.4g\n", name, static_cast<double>(film.mean.r) / mean - 1.0,
                    static_cast<double>(film.squares.r), squares);
        EXPECT_NEAR(static_cast<double>(film.mean.r), mean, 1e-5 * mean) << name;
        EXPECT_GE(film.squares.r, 0.0F) << name;
        // A constant's block sums round alike: its squares are rounding only.
        EXPECT_NEAR(static_cast<double>(film.squares.r), squares, 1e-3 * squares + 1e-12 * mean * mean * blocks) << name;
    }
}

}  // namespace glim::moments_test
