// The course's two rules divide at the mean and at the median, and cost more than the surface-area heuristic in uneven scenes.
#include "host/bvh/build_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <random>

namespace glim {
namespace {

using Boxes = std::vector<Box>;

// Unit cubes whose lower corners are at `places` along one axis.
Boxes makeCubes(const std::vector<float>& places, int axis)
{
    Boxes boxes;
    for (const float place : places) {
        glm::vec3 lo(0.0F);
        lo[axis] = place;
        boxes.push_back({lo, lo + 1.0F});
    }
    return boxes;
}

std::vector<std::uint32_t> makeTestPrimitives(const Bvh& bvh, std::size_t leaf)
{
    const auto first = bvh.order.begin() + bvh.nodes[leaf].first;
    std::vector<std::uint32_t> primitives(first, first + bvh.nodes[leaf].count);
    std::sort(primitives.begin(), primitives.end());
    return primitives;
}

// By hand: the mean of 0 1 2 3 4 5 6 35 is 7; one cube lies above it. The other seven have mean 3, with three cubes below. Of these two
// halves, the first splits above 0, the second in the middle. Half the area of a row of n cubes is 2 n + 1.
TEST(SplitRules, MeanSplitsAtTheMeanOfTheCentres)
{
    for (const int axis : {0, 1, 2}) {
        const Bvh bvh = buildBvh(makeCubes({3, 35, 0, 5, 1, 6, 2, 4}, axis), SplitRule::Mean);
        ASSERT_EQ(bvh.nodes.size(), 9U);
        EXPECT_EQ(makeTestPrimitives(bvh, 2), (std::vector<std::uint32_t>{1}));
        EXPECT_EQ(makeTestPrimitives(bvh, 5), (std::vector<std::uint32_t>{2}));
        EXPECT_EQ(makeTestPrimitives(bvh, 6), (std::vector<std::uint32_t>{4, 6}));
        EXPECT_EQ(makeTestPrimitives(bvh, 7), (std::vector<std::uint32_t>{0, 7}));
        EXPECT_EQ(makeTestPrimitives(bvh, 8), (std::vector<std::uint32_t>{3, 5}));
        EXPECT_EQ(bvh.depth, 3U);
        EXPECT_NEAR(bvh.cost, 1.0 + (15.0 + 7.0 + 9.0 + 3.0 + 3.0 + 3 * 2 * 5.0) / 73.0, 1e-12);
    }
}

// By hand: four on either side, 4 and 32 long, then two, of which the last are 30.
TEST(SplitRules, MedianSplitsByCount)
{
    const Bvh bvh = buildBvh(makeCubes({3, 35, 0, 5, 1, 6, 2, 4}, 0), SplitRule::Median);
    ASSERT_EQ(bvh.nodes.size(), 7U);
    EXPECT_EQ(makeTestPrimitives(bvh, 3), (std::vector<std::uint32_t>{2, 4}));
    EXPECT_EQ(makeTestPrimitives(bvh, 4), (std::vector<std::uint32_t>{0, 6}));
    EXPECT_EQ(makeTestPrimitives(bvh, 5), (std::vector<std::uint32_t>{3, 7}));
    EXPECT_EQ(makeTestPrimitives(bvh, 6), (std::vector<std::uint32_t>{1, 5}));
    EXPECT_NEAR(bvh.cost, 1.0 + (9.0 + 65.0 + 2.0 * (5.0 + 5.0 + 5.0 + 61.0)) / 73.0, 1e-12);
}

// Two primitives are a leaf even where a split would pay, which the heuristic sees.
TEST(SplitRules, TheCoursesLeavesHoldUpToTwo)
{
    const Boxes boxes = makeCubes({0, 10}, 0);
    EXPECT_EQ(buildBvh(boxes, SplitRule::Mean).nodes.size(), 1U);
    EXPECT_EQ(buildBvh(boxes, SplitRule::Median).nodes.size(), 1U);
    EXPECT_EQ(buildBvh(boxes, SplitRule::Sah).nodes.size(), 3U);
}

TEST(SplitRules, TheHeuristicIsTheDefault)
{
    const Boxes boxes = makeCubes({3, 35, 0, 5, 1, 6, 2, 4}, 0);
    EXPECT_EQ(buildBvh(boxes).order, buildBvh(boxes, SplitRule::Sah).order);
    EXPECT_EQ(buildBvh(boxes).cost, buildBvh(boxes, SplitRule::Sah).cost);
}

// 10,000 small boxes in a corner of a hall of 2,000 large ones.
Boxes makeTeapotInAStadium()
{
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    Boxes boxes;
    const auto scatter = [&](int count, float place, float room, float size) {
        for (int i = 0; i < count; ++i) {
            const glm::vec3 lo = glm::vec3(place) + room * glm::vec3(unit(generator), unit(generator), unit(generator));
            boxes.push_back({lo, lo + size * glm::vec3(unit(generator), unit(generator), unit(generator))});
        }
    };
    scatter(10000, 20.0F, 0.3F, 0.01F);
    scatter(2000, 0.0F, 100.0F, 10.0F);
    return boxes;
}

TEST(SplitRules, TheHeuristicIsCheapestWhereASceneIsUneven)
{
    const Boxes boxes = makeTeapotInAStadium();
    const double sah = buildBvh(boxes, SplitRule::Sah).cost, mean = buildBvh(boxes, SplitRule::Mean).cost,
                 median = buildBvh(boxes, SplitRule::Median).cost;
    std::cout << "teapot in a stadium: cost " << sah << " by area, " << mean << " at the mean, " << median << " at the median\n";
    EXPECT_LT(sah, mean);
    EXPECT_LT(sah, median);
    EXPECT_NE(mean, median);
}

}  // namespace
}  // namespace glim
