// Binning costs nothing that counts: the builder's trees are as good as those of a full sweep. Its threads change nothing.
#include "host/bench/make_hills.hpp"
#include "host/bvh/build_bvh.hpp"
#include "host/bvh/collapse_bvh.hpp"
#include "host/bvh/parallel_for.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "tests/support/bench_scenes.hpp"
#include "tests/support/sweep_tree.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace glim {
namespace {

// By hand: four unit cubes in a row, two far from the other two; root 13 x 1 x 1, each pair 2 x 1 x 1, in which two are a leaf.
TEST(BvhQuality, TheSweepsCostIsTheExpectedNumberOfSteps)
{
    const auto cube = [](float x) { return Box{glm::vec3(x, 0, 0), glm::vec3(x + 1, 1, 1)}; };
    const std::vector<Box> boxes{cube(12), cube(0), cube(11), cube(1)};
    EXPECT_NEAR(computeSweepCost(boxes), 1.0 + 2.0 * 2.0 * (5.0 / 27.0), 1e-12);
}

TEST(BvhQuality, CostIsWithinFivePercentOfAFullSweeps)
{
    for (const auto& [name, scene] : {std::pair{"bumpy ball in a box", bumpyBall(6)},
                                      {"hills", makeHills(150)},
                                      {"forest", forest(40)},
                                      {"random triangles", makeTestScene(randomTriangles(30000, 0.05F, 1))}}) {
        const std::vector<Box> boxes = primitiveBoxes(makePrimitives(scene));
        const double sweep = computeSweepCost(boxes), cost = buildBvh(boxes).cost;
        std::cout << name << ": " << boxes.size() << " triangles, cost " << cost << ", with a full sweep " << sweep << ", ratio "
                  << cost / sweep << "\n";
        EXPECT_LE(cost, 1.05 * sweep) << name;
    }
}

bool areEqual(const WideNode& a, const WideNode& b)
{
    return std::equal(a.children.begin(), a.children.end(), b.children.begin(), [](const WideChild& c, const WideChild& d) {
        return c.kind == d.kind && c.first == d.first && c.count == d.count && c.box.lo == d.box.lo && c.box.hi == d.box.hi;
    });
}

// More primitives than one thread builds alone.
TEST(BvhThreads, AnyNumberGivesTheSameTrees)
{
    for (const Triangles& mesh :
         {terrain(150), randomTriangles(30000, 0.05F, 1), coincidentTriangles(30000), growingLine(30000, 1e-10F, 1.001)}) {
        const std::vector<Box> boxes = primitiveBoxes(makeTestPrimitives(mesh));
        for (const SplitRule rule : {SplitRule::Sah, SplitRule::Mean, SplitRule::Median}) {
            const Bvh alone = buildBvh(boxes, rule, 1);
            const WideBvh wideAlone = collapseBvh(alone, {}, 1);
            for (const unsigned threads : {0U, 2U, 3U, 8U}) {
                const Bvh bvh = buildBvh(boxes, rule, threads);
                EXPECT_EQ(bvh.order, alone.order);
                ASSERT_EQ(bvh.nodes.size(), alone.nodes.size());
                EXPECT_EQ(std::memcmp(bvh.nodes.data(), alone.nodes.data(), bvh.nodes.size() * sizeof(BvhNode)), 0);
                EXPECT_EQ(std::pair(bvh.depth, bvh.cost), std::pair(alone.depth, alone.cost));
                const WideBvh wide = collapseBvh(bvh, {}, threads);
                EXPECT_EQ(wide.order, wideAlone.order);
                EXPECT_TRUE(std::ranges::equal(wide.nodes, wideAlone.nodes, areEqual));
                EXPECT_EQ(std::pair(wide.depth, wide.cost), std::pair(wideAlone.depth, wideAlone.cost));
            }
        }
    }
}

TEST(BvhThreads, ParallelForCallsOnceForEach)
{
    for (const unsigned threads : {0U, 1U, 2U, 7U}) {
        for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
            std::vector<std::atomic<int>> calls(count);
            parallelFor(count, threads, [&](std::size_t i) { ++calls[i]; });
            EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](const std::atomic<int>& n) { return n == 1; }))
                << threads << " " << count;
        }
    }
}

TEST(BvhThreads, ParallelForThrowsWhatACallThrew)
{
    for (const unsigned threads : {1U, 3U}) {
        for (const std::size_t bad : {0U, 99U}) {
            const auto work = [bad](std::size_t i) {
                if (i == bad) {
                    throw std::runtime_error("bad");
                }
            };
            EXPECT_THROW(parallelFor(100, threads, work), std::runtime_error) << threads << " " << bad;
        }
    }
}

}  // namespace
}  // namespace glim
