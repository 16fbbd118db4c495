// The times of paths: stratified within a block of samples, others in the next block, and one time where that is asked for.
#include "shaders/shared/features.h"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

namespace glim::path_time_test {

constexpr std::uint32_t kPixels = 64, kSamples = 2 * kFirstBlockSamples;

std::vector<float> timesOf(bool isLight, float begin, float span)
{
    const SceneOnDevice onDevice(makeTestScene(icosphere(0)));
    KernelTest test = onDevice.test(test_kernels::path_time_test);
    test.features(kFeatureMotion);
    test.parameters().timeBegin = begin;
    test.parameters().timeSpan = span;
    test.parameters().lightPaths = kPixels;
    test.cases(std::vector<uint>(kPixels * kSamples, isLight ? 1 : 0)).resultsOf<float>(kPixels * kSamples).run();
    return test.results<float>();
}

// How many of as many equal parts of the shutter have one of the times.
std::size_t countStrata(std::span<const float> times)
{
    std::set<int> met;
    for (const float time : times) {
        EXPECT_TRUE(time >= 0.0F && time < 1.0F);
        met.insert(static_cast<int>(time * static_cast<float>(times.size())));
    }
    return met.size();
}

TEST(PathTimeTest, IsStratifiedWithinABlock)
{
    const std::vector<float> times = timesOf(false, 0.0F, 1.0F);
    std::set<float> all(times.begin(), times.end());
    EXPECT_EQ(all.size(), times.size()) << "no block has the times of another";
    for (std::uint32_t block = 0; block < kPixels * kSamples / kFirstBlockSamples; ++block) {
        EXPECT_EQ(countStrata(std::span(times).subspan(std::size_t{block} * kFirstBlockSamples, kFirstBlockSamples)), kFirstBlockSamples);
    }
}

TEST(PathTimeTest, OfLightPathsIsStratifiedOverAll)
{
    const std::vector<float> times = timesOf(true, 0.0F, 1.0F);
    std::vector<float> firstBlock;
    for (std::uint32_t path = 0; path < kPixels; ++path) {
        firstBlock.insert(firstBlock.end(), times.begin() + path * kSamples, times.begin() + path * kSamples + kFirstBlockSamples);
    }
    EXPECT_EQ(countStrata(firstBlock), firstBlock.size());
}

TEST(PathTimeTest, MayBeOneForAll)
{
    for (const float time : timesOf(false, 0.375F, 0.0F)) {
        EXPECT_EQ(time, 0.375F);
    }
}

}  // namespace glim::path_time_test
