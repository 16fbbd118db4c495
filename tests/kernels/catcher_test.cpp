// The second paths of samples where shadow catchers are.
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::catcher_test {

constexpr uint kFronts = 1, kWithoutObjects = 4;  // bvh_traversal.glsl
constexpr uint kSamples = 4;                      // of each pixel in a pass

struct Case {
    uint slot, bounce;
    float alpha;
};

struct Result {
    uint pixel, sampleIndex;
    uint sides;
    uint ends;
    uint slots;
};

// A pass of as many pixels as there are cases.
std::vector<Result> find(const std::vector<Case>& cases, FeatureMask features)
{
    KernelTest test(test_kernels::catcher_test);
    test.features(features).cases(cases).resultsOf<Result>(cases.size()).specialize(kSpecChosen, 0);
    test.pass().sampleCount = kSamples;
    test.run();
    return test.results<Result>();
}

TEST(CatcherTest, ASampleHasASecondPathWithTheSameNumbers)
{
    const std::vector<Case> cases{{9, 0, 1.0F}, {9, 1, 1.0F}, {9 + 24, 0, 1.0F}, {9 + 24, 0, -1.0F}, {9 + 24, 1, 1.0F}, {9, 0, -1.0F}};
    const std::vector<Result> results = find(cases, kFeatureCatcher);
    for (const Result& result : results) {
        EXPECT_EQ(result.pixel, 9 / kSamples);
        EXPECT_EQ(result.sampleIndex, 9 % kSamples);
        EXPECT_EQ(result.slots, 2 * kSamples * cases.size());
    }
    for (const std::size_t i : {0, 1, 2, 3, 5}) {
        EXPECT_EQ(results[i].sides, kFronts) << "the camera's ray meets all, as all rays of the first path do; case " << i;
    }
    EXPECT_EQ(results[4].sides, kFronts | kWithoutObjects);
    for (std::size_t i = 0; i < results.size(); ++i) {
        EXPECT_EQ(results[i].ends, i == 2 ? 1U : 0U) << "at an object that it met first; case " << i;
    }
}

TEST(CatcherTest, OtherScenesHaveOnePath)
{
    const std::vector<Result> results = find({{3, 0, 1.0F}, {3, 2, 1.0F}}, 0);
    for (const Result& result : results) {
        EXPECT_EQ(result.sampleIndex, 3U);
        EXPECT_EQ(result.sides, kFronts);
        EXPECT_EQ(result.ends, 0U);
        EXPECT_EQ(result.slots, 2 * kSamples);
    }
}

}  // namespace glim::catcher_test
