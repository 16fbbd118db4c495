// The kernel itself. It counts and locates samples that are not finite, and adds them to no sum. In adaptive renders it adds to
// the chosen pixels. With --suspects it keeps the brightest sample of each pixel.
#include "host/gpu/commands.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/path_buffers.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/path_types.h"
#include "shaders/shared/pixel_moments.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/blocks.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/parameters_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace glim::accumulate_test {

constexpr std::uint32_t kPixels = 100, kSamples = 8, kTileBegin = 1000, kFirstSample = 32;

struct Outcome {
    std::vector<PixelMoments> pages;
    std::vector<LuminanceMoments> luminances;
    std::vector<BrightestSample> brightest;
    Status status;
};

// An empty `chosen` means: the render is not adaptive. Brightest samples start as `brightest`.
Outcome accumulate(const std::vector<PathRadiance>& radiance, const std::vector<ChosenPixel>& chosen = {}, uint flags = kEndsBlock,
                   const std::vector<BrightestSample>& brightest = {})
{
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    Specialization constants = makeConstants(0);
    constants.insert({{kSpecWorkgroup, 64}, {kSpecChosen, !chosen.empty()}, {kSpecSuspects, !brightest.empty()}});
    const Kernel kernel(layout, kernels::accumulate, constants);
    const Kernel luminance(layout, kernels::course_add_luminance, {{kSpecWorkgroup, 64}, {kSpecChosen, !chosen.empty()}});
    Buffer list(testDevice(), "test's choice", BufferKind::Storage, sizeof(uint) + kPixels * sizeof(ChosenPixel));
    std::vector<uint> counted{kPixels};
    for (const ChosenPixel& each : chosen) {
        counted.insert(counted.end(), {each.pixel, each.samplesBefore});
    }
    upload(list, std::span<const uint>(counted));
    Buffer luminances(testDevice(), "test's luminances", BufferKind::Storage, kPixels * sizeof(LuminanceMoments));
    upload(luminances, std::span<const LuminanceMoments>(std::vector<LuminanceMoments>(kPixels)));
    Buffer kept(testDevice(), "test's brightest samples", BufferKind::Storage, kPixels * sizeof(BrightestSample));
    upload(kept, std::span<const BrightestSample>(brightest.empty() ? std::vector<BrightestSample>(kPixels) : brightest));
    PathBuffers paths(testDevice(), kPixels * kSamples);
    Buffer blocks(testDevice(), "test's blocks", BufferKind::Storage, kPixels * sizeof(BlockSums));
    Buffer pages(testDevice(), "test's pages", BufferKind::Storage, kPixels * sizeof(PixelMoments));
    Buffer given(testDevice(), "test's radiance", BufferKind::Both, radiance.size() * sizeof(PathRadiance));
    Buffer firstHits(testDevice(), "test's first hits", BufferKind::Both, radiance.size() * sizeof(FirstHit));
    upload(blocks, std::span<const BlockSums>(std::vector<BlockSums>(kPixels)));
    upload(pages, std::span<const PixelMoments>(std::vector<PixelMoments>(kPixels)));
    upload(given, std::span<const PathRadiance>(radiance));
    upload(firstHits, std::span<const FirstHit>(std::vector<FirstHit>(radiance.size())));
    std::map<std::uint32_t, const Buffer*> bound = paths.buffers(0);
    bound[kBindRadiance] = &given;
    bound[kBindFirstHits] = &firstHits;
    bound[kBindBlocks] = &blocks;
    bound[kBindPages] = &pages;
    bound[kBindChosenPixels] = &list;
    bound[kBindLuminance] = &luminances;
    bound[kBindBrightest] = &kept;
    const Buffer parameters = parametersBuffer(anyParameters());
    bound[kBindParameters] = &parameters;
    const Bindings bindings(layout, bound);
    Pass pass{};
    pass.tileBegin = kTileBegin;
    pass.pixelCount = kPixels;
    pass.firstSample = kFirstSample;
    pass.sampleCount = kSamples;
    pass.accumulate = flags;
    Commands commands(testDevice());
    const auto push = std::as_bytes(std::span<const Pass, 1>(&pass, 1));
    commands.dispatch(kernel, bindings, push, (kPixels + 63) / 64);
    if (!chosen.empty()) {
        commands.dispatch(luminance, bindings, push, (kPixels + 63) / 64);
    }
    commands.submitAndWait();
    return {download<PixelMoments>(pages, kPixels), download<LuminanceMoments>(luminances, kPixels),
            download<BrightestSample>(kept, kPixels), download<Status>(paths.status(), 1)[0]};
}

// Means of samples and products of their deviations, in double.
struct Reference {
    std::vector<double> means, products;
};

// By light groups, over blocks that end with sample 63 (test::blockEnd): the samples of one pixel, each with a value of each group.
Reference foldBlocks(const std::vector<std::vector<double>>& samples, std::uint32_t first)
{
    const std::size_t groups = samples[0].size();
    std::vector<std::vector<double>> blocks;
    std::vector<double> counts;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto sample = static_cast<std::uint32_t>(first + i);
        if (i == 0 || test::blockEnd(sample) != test::blockEnd(sample - 1)) {
            blocks.emplace_back(groups, 0.0);
            counts.push_back(0.0);
        }
        counts.back() += 1.0;
        for (std::size_t g = 0; g < groups; ++g) {
            blocks.back()[g] += samples[i][g];
        }
    }
    Reference reference{std::vector<double>(groups, 0.0), {}};
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        for (std::size_t g = 0; g < groups; ++g) {
            reference.means[g] += blocks[b][g] / static_cast<double>(samples.size());
            blocks[b][g] /= counts[b];
        }
    }
    for (std::size_t g = 0; g < groups; ++g) {
        for (std::size_t other = g; other < groups; ++other) {
            double sum = 0.0;
            for (std::size_t b = 0; b < blocks.size(); ++b) {
                sum += counts[b] * (blocks[b][g] - reference.means[g]) * (blocks[b][other] - reference.means[other]);
            }
            reference.products.push_back(sum);
        }
    }
    return reference;
}

TEST(AccumulateTest, KeepsMeansAndProductsOfLightGroups)
{
    constexpr std::uint32_t kGroups = 3, kFirst = 60;  // a block of four samples and another one of four
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    Specialization constants = makeConstants(kFeatureLightGroups);
    constants.insert({{kSpecWorkgroup, 64}, {kSpecChosen, 0}, {kSpecSuspects, 0}});
    const Kernel kernel(layout, kernels::accumulate, constants);
    const PathBuffers paths(testDevice(), kPixels * kSamples, kGroups);
    const auto zeros = [](const char* name, std::size_t bytes, BufferKind kind = BufferKind::Storage) {
        Buffer buffer(testDevice(), name, kind, bytes);
        upload(buffer, std::span<const std::byte>(std::vector<std::byte>(bytes)));
        return buffer;
    };
    const Buffer blocks = zeros("test's blocks", kPixels * sizeof(BlockSums)),
                 pages = zeros("test's pages", kPixels * sizeof(PixelMoments));
    const Buffer sums = zeros("test's groups", kPixels * sumsOfGroups(kGroups) * sizeof(vec3));
    Buffer given(testDevice(), "test's radiance", BufferKind::Both, kPixels * kSamples * sizeof(PathRadiance));
    Buffer light(testDevice(), "test's light", BufferKind::Storage, kPixels * kSamples * (1 + 3 * kGroups) * sizeof(float));
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0F, 2.0F);
    std::vector<PathRadiance> radiance(kPixels * kSamples);
    std::vector<float> words;
    std::vector<std::vector<std::vector<double>>> samples(kPixels);  // the green of each group
    for (std::uint32_t slot = 0; slot < kPixels * kSamples; ++slot) {
        const bool isLost = slot == 3 * kSamples + 5;
        radiance[slot].radiance = vec3(isLost ? std::numeric_limits<float>::infinity() : 1.0F);
        std::vector<double> sample;
        words.push_back(0.0F);
        for (std::uint32_t g = 0; g < kGroups; ++g) {
            words.insert(words.end(), {uniform(random), uniform(random), uniform(random)});
            sample.push_back(static_cast<double>(words[words.size() - 2]));
        }
        if (!isLost) {
            samples[slot / kSamples].push_back(sample);
        }
    }
    upload(given, std::span<const PathRadiance>(radiance));
    upload(light, std::span<const float>(words));
    RenderParameters asked = anyParameters();
    asked.lightGroups = kGroups;
    const Buffer parameters = parametersBuffer(asked);
    std::map<std::uint32_t, const Buffer*> bound = paths.buffers(0);
    bound[kBindRadiance] = &given;
    bound[kBindGroupLight] = &light;
    bound[kBindGroupSums] = &sums;
    bound[kBindBlocks] = &blocks;
    bound[kBindPages] = &pages;
    bound[kBindParameters] = &parameters;
    const Bindings bindings(layout, bound);
    Pass pass{};
    pass.pixelCount = kPixels;
    pass.firstSample = kFirst;
    pass.sampleCount = kSamples;
    pass.accumulate = kEndsBlock;
    Commands commands(testDevice());
    commands.dispatch(kernel, bindings, std::as_bytes(std::span<const Pass, 1>(&pass, 1)), (kPixels + 63) / 64);
    commands.submitAndWait();
    const std::vector<vec3> all = download<vec3>(sums, kPixels * sumsOfGroups(kGroups));
    const std::vector<PixelMoments> counted = download<PixelMoments>(pages, kPixels);
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        SCOPED_TRACE(pixel);
        const vec3* of = &all[pixel * sumsOfGroups(kGroups)];
        // The lost sample is the second of its block, so that the others stay where they are.
        const Reference expected = pixel == 3 ? Reference{} : foldBlocks(samples[pixel], kFirst);
        EXPECT_EQ(counted[pixel].count, pixel == 3 ? kSamples - 1 : kSamples);
        for (std::uint32_t g = 0; g < kGroups; ++g) {
            EXPECT_EQ(of[g], vec3(0.0F)) << "the next block is empty";
            if (pixel != 3) {
                EXPECT_NEAR(static_cast<double>(of[kGroups + g].g), expected.means[g], 1e-6);
            }
        }
        for (std::size_t pair = 0; pair < expected.products.size(); ++pair) {
            EXPECT_NEAR(static_cast<double>(of[2 * kGroups + pair].g), expected.products[pair], 2e-6);
        }
        double sum = 0.0;
        for (const std::vector<double>& sample : samples[pixel]) {
            sum += sample[0];
        }
        EXPECT_NEAR(static_cast<double>(of[kGroups].g), sum / static_cast<double>(samples[pixel].size()), 1e-6) << "without what is lost";
    }
}

// Pixels whose plain average over their samples is not finite.
std::uint32_t countPoisoned(const std::vector<PathRadiance>& radiance)
{
    std::uint32_t poisoned = 0;
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        vec3 sum(0.0F);
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            sum += radiance[pixel * kSamples + i].radiance;
        }
        poisoned += std::isfinite(sum.r + sum.g + sum.b) ? 0 : 1;
    }
    return poisoned;
}

TEST(AccumulateTest, H37LeavesOutWhatIsNotFinite)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<PathRadiance> radiance(kPixels * kSamples, {vec3(1.0F, 2.0F, 4.0F), 0.0F});
    // Pixel 7 loses a sample in each channel, pixel 50 all.
    radiance[7 * kSamples + 0].radiance.r = nan;
    radiance[7 * kSamples + 3].radiance.g = infinity;
    radiance[7 * kSamples + 7].radiance.b = -infinity;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        radiance[50 * kSamples + i].radiance = vec3(nan);
    }
    const Outcome outcome = accumulate(radiance);
    printHardCase("H37", "11 samples of 2 pixels are not finite", kPixels * kSamples,
                  std::to_string(outcome.status.nonFinite) + " counted and left out",
                  "plain average: " + std::to_string(countPoisoned(radiance)) + " pixels are not finite");
    EXPECT_EQ(countPoisoned(radiance), 2U);
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const std::uint32_t kept = pixel == 7 ? kSamples - 3 : pixel == 50 ? 0 : kSamples;
        EXPECT_EQ(outcome.pages[pixel].count, kept) << pixel;
        EXPECT_EQ(outcome.pages[pixel].mean, kept > 0 ? vec3(1.0F, 2.0F, 4.0F) : vec3(0.0F)) << pixel;
    }
    EXPECT_EQ(outcome.status.nonFinite, 3 + kSamples);
    std::set<std::pair<std::uint32_t, std::uint32_t>> located;
    for (std::uint32_t i = 0; i < std::min(outcome.status.nonFinite, kMaxLocated); ++i) {
        located.insert({outcome.status.located[i].pixel, outcome.status.located[i].sampleIndex});
    }
    EXPECT_EQ(located.size(), 3 + kSamples);
    EXPECT_EQ(located.count({kTileBegin + 7, kFirstSample + 3}), 1U);
    EXPECT_EQ(located.count({kTileBegin + 50, kFirstSample + 7}), 1U);
}

TEST(AccumulateTest, AddsToTheChosenPixels)
{
    std::vector<PathRadiance> radiance(kPixels * kSamples);
    std::vector<ChosenPixel> chosen(kPixels);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        chosen[i].pixel = kPixels - 1 - i;
        for (std::uint32_t k = 0; k < kSamples; ++k) {
            radiance[i * kSamples + k].radiance = vec3(static_cast<float>(i + k), 0.0F, 0.0F);
        }
    }
    const Outcome outcome = accumulate(radiance, chosen);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        const float mean = static_cast<float>(i) + 3.5F;
        EXPECT_FLOAT_EQ(outcome.pages[chosen[i].pixel].mean.r, mean);
        const LuminanceMoments& moments = outcome.luminances[chosen[i].pixel];
        EXPECT_EQ(moments.count, kSamples);
        EXPECT_NEAR(moments.mean, 0.2126F * mean, 1e-6F * mean);
        EXPECT_NEAR(moments.squares, 0.2126F * 0.2126F * 42.0F, 1e-4F);  // sum of (k - 3.5)^2 over 0 to 7
    }
    EXPECT_EQ(accumulate(radiance).luminances[0].count, 0U);
    const Outcome every = accumulate(radiance, chosen, kEndsBlock | kEveryPixel);
    EXPECT_FLOAT_EQ(every.pages[10].mean.r, 13.5F);
}

// Each chosen pixel continues with its own next sample. Blocks end by the sample's index, within the pass or at its end.
TEST(AccumulateTest, ChosenPixelsGoOnFromTheirOwnSamples)
{
    std::vector<PathRadiance> radiance(kPixels * kSamples);
    std::vector<ChosenPixel> chosen(kPixels);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        chosen[i] = {i, 3 * i};
        for (std::uint32_t k = 0; k < kSamples; ++k) {
            radiance[i * kSamples + k].radiance = vec3(static_cast<float>(k), 0.0F, 0.0F);
        }
    }
    radiance[50 * kSamples + 2].radiance.g = std::numeric_limits<float>::infinity();
    const Outcome outcome = accumulate(radiance, chosen, kEndsBlock, std::vector<BrightestSample>(kPixels));
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        SCOPED_TRACE(i);
        const std::uint32_t first = kFirstSample + 3 * i, toEnd = test::blockEnd(first) - first;
        EXPECT_EQ(outcome.pages[i].blocks, toEnd < kSamples ? 2U : 1U);
        EXPECT_EQ(outcome.pages[i].count, i == 50 ? kSamples - 1 : kSamples);
        EXPECT_EQ(outcome.brightest[i].sampleIndex, first + kSamples - 1);
        if (i != 50) {
            // Means (m - 1) / 2 and (m + 7) / 2 of m and 8 - m samples: m (8 - m) / 8 times the square of what is between them.
            const float m = static_cast<float>(std::min(toEnd, kSamples));
            EXPECT_FLOAT_EQ(outcome.pages[i].mean.r, 3.5F);
            EXPECT_FLOAT_EQ(outcome.pages[i].squares.r, m * (8.0F - m) / 8.0F * 16.0F);
        }
    }
    EXPECT_EQ(outcome.status.nonFinite, 1U);
    EXPECT_EQ(outcome.status.located[0].pixel, kTileBegin + 50);
    EXPECT_EQ(outcome.status.located[0].sampleIndex, kFirstSample + 150 + 2);
}

TEST(AccumulateTest, KeepsTheFirstBrightestSample)
{
    std::vector<PathRadiance> radiance(kPixels * kSamples);
    std::vector<BrightestSample> before(kPixels);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        // Green outshines red; samples i % 8 and, as bright, the last.
        radiance[i * kSamples + i % kSamples].radiance = radiance[i * kSamples + kSamples - 1].radiance = vec3(0.0F, 1.0F, 0.0F);
        radiance[i * kSamples + (i + 3) % (kSamples - 1)].radiance += vec3(0.5F, 0.0F, 0.0F);
    }
    radiance[3 * kSamples + 5].radiance = vec3(std::numeric_limits<float>::infinity());
    std::fill_n(radiance.begin() + 20 * kSamples, kSamples, PathRadiance{});
    before[40] = {9.0F, 7};
    const Outcome outcome = accumulate(radiance, {}, kEndsBlock, before);
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        SCOPED_TRACE(i);
        float luminance = -1.0F;
        std::uint32_t sample = 0;
        for (std::uint32_t k = 0; k < kSamples; ++k) {
            const vec3 color = radiance[i * kSamples + k].radiance;
            const float value = 0.2126F * color.r + 0.7152F * color.g;
            if (value > luminance && value < 1e9F) {
                luminance = value;
                sample = kFirstSample + k;
            }
        }
        EXPECT_FLOAT_EQ(outcome.brightest[i].luminance, i == 40 ? 9.0F : luminance);
        EXPECT_EQ(outcome.brightest[i].sampleIndex, i == 20 ? 0 : i == 40 ? 7 : sample);
    }
    EXPECT_EQ(accumulate(radiance).brightest[0].luminance, 0.0F);
}

}  // namespace glim::accumulate_test
