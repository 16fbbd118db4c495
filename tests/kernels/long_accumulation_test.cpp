// H26, H27: 1e5 samples of a pixel through the kernel that adds them up.
#include "host/gpu/commands.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/path_buffers.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "tests/harness/random.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/parameters_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>

namespace glim::long_accumulation_test {

// Different blocks, added again and again: 102,400 samples.
constexpr std::uint32_t kBlocks = 64, kTurns = 25, kPixels = 64;
constexpr double kSamples = 1.0 * kBlocks * kTurns * kBlockSamples;

using Samples = std::vector<PathRadiance>;  // of one block of all pixels

void runTurns(const KernelLayout& layout, const std::deque<Bindings>& bindings)
{
    Specialization constants = makeConstants(0);
    constants[kSpecWorkgroup] = 64;
    const Kernel kernel(layout, kernels::accumulate, constants);
    Pass pass{};
    pass.pixelCount = kPixels;
    pass.firstSample = pass.sampleCount = kBlockSamples;
    pass.accumulate = kEndsBlock;
    for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
        Commands commands(testDevice());
        for (const Bindings& each : bindings) {
            commands.dispatch(kernel, each, std::as_bytes(std::span<const Pass, 1>(&pass, 1)), kPixels / 64);
        }
        commands.submitAndWait();
    }
}

std::vector<PixelMoments> addUp(const std::vector<Samples>& blocks)
{
    const KernelLayout layout(testDevice(), kernelSlots(), sizeof(CoursePass));
    PathBuffers paths(testDevice(), kPixels * kBlockSamples);
    Buffer open(testDevice(), "test's blocks", BufferKind::Storage, kPixels * sizeof(BlockSums));
    Buffer pages(testDevice(), "test's pages", BufferKind::Storage, kPixels * sizeof(PixelMoments));
    Buffer firstHits(testDevice(), "test's first hits", BufferKind::Both, blocks[0].size() * sizeof(FirstHit));
    upload(open, std::span<const BlockSums>(std::vector<BlockSums>(kPixels)));
    upload(pages, std::span<const PixelMoments>(std::vector<PixelMoments>(kPixels)));
    upload(firstHits, std::span<const FirstHit>(std::vector<FirstHit>(blocks[0].size())));
    const Buffer parameters = parametersBuffer(anyParameters());
    std::deque<Buffer> radiances;
    std::deque<Bindings> bindings;
    for (const Samples& block : blocks) {
        radiances.emplace_back(testDevice(), "test's radiance", BufferKind::Both, block.size() * sizeof(PathRadiance));
        upload(radiances.back(), std::span<const PathRadiance>(block));
        std::map<std::uint32_t, const Buffer*> bound = paths.buffers(0);
        bound[kBindRadiance] = &radiances.back();
        bound[kBindFirstHits] = &firstHits;
        bound[kBindBlocks] = &open;
        bound[kBindPages] = &pages;
        // Of adaptive renders, and of those that keep suspects.
        bound[kBindChosenPixels] = &open;
        bound[kBindParameters] = &parameters;
        bound[kBindBrightest] = &pages;
        bindings.emplace_back(layout, bound);
    }
    runTurns(layout, bindings);
    return download<PixelMoments>(pages, kPixels);
}

struct Stream {
    const char* number;
    const char* name;
    std::function<float(Random&)> next;
    double limit;  // of the mean's relative error
};

double naiveMean(const std::vector<Samples>& blocks, std::size_t pixel)
{
    float sum = 0.0F;
    for (std::uint32_t block = 0; block < kBlocks * kTurns; ++block) {
        for (std::uint32_t i = 0; i < kBlockSamples; ++i) {
            sum += blocks[block % kBlocks][pixel * kBlockSamples + i].radiance.g;
        }
    }
    return static_cast<double>(sum) / kSamples;
}

TEST(LongAccumulationTest, H26H27HundredThousandSamples)
{
    const std::vector<Stream> streams = {
        // Equal samples round in each block alike, by 2^-24 in most steps.
        {"H27", "constant .1", [](Random&) { return 0.1F; }, 1e-6},
        {"H26", "1 + .001 N", [](Random& r) { return static_cast<float>(1.0 + 0.001 * r.normal()); }, 1e-5},
        {"H26", "1e4 (1 + .01 N)", [](Random& r) { return static_cast<float>(1e4 * (1.0 + 0.01 * r.normal())); }, 1e-5},
        {"H26", "lognormal", [](Random& r) { return static_cast<float>(std::exp(r.normal())); }, 1e-5},
        {"H26", ".3, one in 1e4 is 1e4", [](Random& r) { return r.below(10000) == 0 ? 1e4F : 0.3F; }, 1e-5}};
    std::vector<Samples> blocks(kBlocks, Samples(kPixels * kBlockSamples, {vec3(0.0F), 0.0F}));
    std::vector<double> sums(kPixels, 0.0);
    Random random(26);
    for (Samples& block : blocks) {
        for (std::uint32_t i = 0; i < block.size(); ++i) {
            const std::uint32_t pixel = i / kBlockSamples;
            block[i].radiance.g = streams[pixel % streams.size()].next(random);
            sums[pixel] += static_cast<double>(block[i].radiance.g);
        }
    }
    const std::vector<PixelMoments> pages = addUp(blocks);
    for (std::size_t s = 0; s < streams.size(); ++s) {
        double worst = 0.0, naiveWorst = 0.0;
        for (std::size_t pixel = s; pixel < kPixels; pixel += streams.size()) {
            EXPECT_EQ(pages[pixel].count, static_cast<std::uint32_t>(kSamples));
            EXPECT_GE(pages[pixel].squares.g, 0.0F);
            const double mean = sums[pixel] / (kBlocks * kBlockSamples);
            worst = std::max(worst, std::abs(static_cast<double>(pages[pixel].mean.g) / mean - 1.0));
            naiveWorst = std::max(naiveWorst, std::abs(naiveMean(blocks, pixel) / mean - 1.0));
        }
        printHardCase(streams[s].number, streams[s].name, kSamples, "mean off by " + figure(worst), "one float sum: " + figure(naiveWorst));
        EXPECT_LE(worst, streams[s].limit) << streams[s].name;
        EXPECT_GT(naiveWorst, streams[s].limit) << streams[s].name;
    }
}

}  // namespace glim::long_accumulation_test
