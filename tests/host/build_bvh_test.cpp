// The tree is valid and shallow whatever the boxes, cheap where a good tree exists, and check_bvh sees every defect.
#include "host/bvh/build_bvh.hpp"
#include "tests/support/check_bvh.hpp"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numeric>
#include <random>

namespace glim {
namespace {

using Boxes = std::vector<Box>;

Boxes makeRandom(std::size_t count, float size, std::uint32_t seed = 1)
{
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> position(-1.0F, 1.0F), extent(0.0F, size);
    Boxes boxes(count);
    for (Box& box : boxes) {
        box.lo = {position(generator), position(generator), position(generator)};
        box.hi = box.lo + glm::vec3(extent(generator), extent(generator), extent(generator));
    }
    return boxes;
}

// The i-th box starts where the one before ends and is `ratio` times its length, from `first` on.
Boxes makeGrowingLine(std::size_t count, double first, double ratio)
{
    Boxes boxes(count);
    double start = 0.0, length = first;
    for (Box& box : boxes) {
        box.lo = glm::vec3(static_cast<float>(start), 0.0F, 0.0F);
        start += length;
        box.hi = glm::vec3(static_cast<float>(start), static_cast<float>(length), static_cast<float>(length));
        length *= ratio;
    }
    return boxes;
}

// Nested boxes that share one corner: each split can only take off the largest.
Boxes makeNested(std::size_t count)
{
    Boxes boxes(count);
    for (std::size_t i = 0; i < count; ++i) {
        boxes[i] = {glm::vec3(0.0F), glm::vec3(std::exp2(static_cast<float>(i % 250) - 125.0F))};
    }
    return boxes;
}

Boxes makeHugeAndTiny()
{
    Boxes boxes = makeRandom(5000, 1e-6F);
    for (const Box& box : makeRandom(50, 1.0F, 2)) {
        boxes.push_back({box.lo * 1e30F, box.lo * 1e30F + (box.hi - box.lo) * 1e30F});
    }
    boxes.push_back({glm::vec3(-3.4e38F), glm::vec3(3.4e38F)});
    return boxes;
}

// Triangles of a height field whose cells shrink towards one corner, as scanned and simplified terrains have them.
Boxes makeTerrain(int cells)
{
    const auto vertex = [cells](int i, int j) {
        const float u = static_cast<float>(i) / static_cast<float>(cells);
        const float v = static_cast<float>(j) / static_cast<float>(cells);
        const float x = 100.0F * u * u * u, z = 100.0F * v * v * v;
        return glm::vec3(x, 4.0F * std::sin(0.3F * x) * std::cos(0.2F * z) + 0.5F * std::sin(3.0F * x + 2.0F * z), z);
    };
    Boxes boxes;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const glm::vec3 a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i, j + 1), d = vertex(i + 1, j + 1);
            boxes.push_back({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
            boxes.push_back({glm::min(d, glm::min(b, c)), glm::max(d, glm::max(b, c))});
        }
    }
    return boxes;
}

struct Input {
    const char* name;
    std::function<Boxes()> make;
};

void PrintTo(const Input& input, std::ostream* out) { *out << input.name; }

using Rule = test::Named<SplitRule>;

class BuildBvhInput : public testing::TestWithParam<std::tuple<Input, Rule>> {};

std::string getName(const testing::TestParamInfo<std::tuple<Input, Rule>>& info)
{
    const auto& [input, rule] = info.param;
    return std::string(input.name) + rule.name;
}

const auto kEveryRule =
    testing::Values(Rule{"BySah", SplitRule::Sah}, Rule{"ByMean", SplitRule::Mean}, Rule{"ByMedian", SplitRule::Median});

TEST_P(BuildBvhInput, GivesAValidTree)
{
    const auto& [input, rule] = GetParam();
    const Boxes boxes = input.make();
    const Bvh bvh = buildBvh(boxes, rule.value);
    const auto defect = findBvhDefect(bvh, boxes);
    EXPECT_FALSE(defect) << *defect;
    EXPECT_LE(bvh.depth, kMaxBvhDepth);
    EXPECT_TRUE(std::isfinite(bvh.cost)) << bvh.cost;
    EXPECT_GT(bvh.cost, 0.0);
    EXPECT_TRUE(std::all_of(bvh.nodes.begin(), bvh.nodes.end(), [](const BvhNode& node) { return node.count <= 4; }));
    std::cout << input.name << ": " << boxes.size() << " boxes, depth " << bvh.depth << ", cost " << bvh.cost << "\n";
}

constexpr float kHuge = 1e30F;
INSTANTIATE_TEST_SUITE_P(
    Worst, BuildBvhInput,
    testing::Combine(testing::Values(Input{"One", [] { return makeRandom(1, 1.0F); }}, Input{"Two", [] { return makeRandom(2, 0.1F); }},
                                     Input{"Five", [] { return makeRandom(5, 0.1F); }},
                                     Input{"Coincident",
                                           [] {
                                               return Boxes(100000, Box{glm::vec3(1), glm::vec3(2)});
                                           }},
                                     Input{"CoincidentPoints",
                                           [] {
                                               return Boxes(100000, Box{glm::vec3(1), glm::vec3(1)});
                                           }},
                                     Input{"CoincidentHuge",
                                           [] {
                                               return Boxes(1000, Box{glm::vec3(-kHuge), glm::vec3(kHuge)});
                                           }},
                                     Input{"DoublingLine", [] { return makeGrowingLine(250, 1e-37, 2.0); }},
                                     Input{"GrowingLine", [] { return makeGrowingLine(100000, 1e-30, 1.001); }},
                                     Input{"Nested", [] { return makeNested(100000); }}, Input{"HugeAndTiny", makeHugeAndTiny},
                                     Input{"PointsOnALine",
                                           [] {
                                               Boxes boxes(100000);
                                               for (std::size_t i = 0; i < boxes.size(); ++i) {
                                                   boxes[i].lo = boxes[i].hi =
                                                       glm::vec3(std::exp(static_cast<float>(i) * 1e-3F), 0.0F, 0.0F);
                                               }
                                               return boxes;
                                           }},
                                     Input{"Denormal",
                                           [] {
                                               return Boxes(makeRandom(1000, 1.0F).size(), Box{glm::vec3(0), glm::vec3(1e-44F)});
                                           }}),
                     kEveryRule),
    getName);
INSTANTIATE_TEST_SUITE_P(Random, BuildBvhInput,
                         testing::Combine(testing::Values(Input{"Points", [] { return makeRandom(20000, 0.0F); }},
                                                          Input{"Small", [] { return makeRandom(20000, 0.01F); }},
                                                          Input{"Overlapping", [] { return makeRandom(20000, 1.0F); }},
                                                          Input{"Terrain", [] { return makeTerrain(100); }}),
                                          kEveryRule),
                         getName);

// Cost of the tree that splits at the median along the widest axis, down to four primitives.
struct MedianTree {
    Boxes boxes;

    static double computeArea(const glm::dvec3& extent) { return 2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x); }

    double computeWeight(std::size_t begin, std::size_t end)
    {
        glm::dvec3 lo(1e300), hi(-1e300);
        for (std::size_t i = begin; i < end; ++i) {
            lo = glm::min(lo, glm::dvec3(boxes[i].lo));
            hi = glm::max(hi, glm::dvec3(boxes[i].hi));
        }
        const glm::dvec3 extent = hi - lo;
        if (end - begin <= 4) {
            return computeArea(extent) * static_cast<double>(end - begin);
        }
        const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
        const std::size_t middle = (begin + end) / 2;
        std::nth_element(boxes.begin() + begin, boxes.begin() + middle, boxes.begin() + end,
                         [axis](const Box& a, const Box& b) { return a.lo[axis] + a.hi[axis] < b.lo[axis] + b.hi[axis]; });
        return computeArea(extent) + computeWeight(begin, middle) + computeWeight(middle, end);
    }

    double computeCost()
    {
        const Box root = std::accumulate(boxes.begin(), boxes.end(), boxes[0], [](const Box& a, const Box& b) {
            return Box{glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)};
        });
        return computeWeight(0, boxes.size()) / computeArea(glm::dvec3(root.hi) - glm::dvec3(root.lo));
    }
};

// Sizes differ: a split by count is wrong almost everywhere.
TEST(BuildBvh, CostsLessThanMedianSplits)
{
    Boxes mixed = makeTerrain(60);
    for (const Box& box : makeRandom(20000, 0.01F)) {
        mixed.push_back({glm::vec3(50, 5, 50) + box.lo, glm::vec3(50, 5, 50) + box.hi});
    }
    for (const auto& [name, boxes, most] : {std::tuple{"terrain", makeTerrain(200), 0.9}, {"mixed", mixed, 0.75}}) {
        const double cost = buildBvh(boxes).cost, median = MedianTree{boxes}.computeCost();
        std::cout << name << ": cost " << cost << ", with median splits " << median << "\n";
        EXPECT_LT(cost, most * median) << name;
    }
}

// By hand: four unit cubes in a row, two far from the other two; root 13 x 1 x 1, each pair 2 x 1 x 1.
TEST(BuildBvh, CostIsTheExpectedNumberOfSteps)
{
    const auto cube = [](float x) { return Box{glm::vec3(x, 0, 0), glm::vec3(x + 1, 1, 1)}; };
    const Boxes boxes{cube(12), cube(0), cube(11), cube(1)};
    const Bvh bvh = buildBvh(boxes);
    ASSERT_EQ(bvh.nodes.size(), 3U);
    EXPECT_EQ(bvh.depth, 1U);
    EXPECT_NEAR(bvh.cost, 1.0 + 2.0 * 2.0 * (10.0 / 54.0), 1e-12);
    EXPECT_LT(bvh.nodes[1].box.lo.x, bvh.nodes[2].box.lo.x) << "the lower side is the first child";
}

// Multiplying by a power of two is exact, so nothing may change, neither at a float's limits nor far below 1.
TEST(BuildBvh, UnitOfLengthDoesNotMatter)
{
    const auto scale = [](Boxes boxes, float factor) {
        for (Box& box : boxes) {
            box = {box.lo * factor, box.hi * factor};
        }
        return boxes;
    };
    const Boxes boxes = scale(makeRandom(5000, 0.01F), 1.9F);
    const Bvh expected = buildBvh(boxes);
    for (const float factor : {std::exp2(127.0F), std::exp2(-100.0F)}) {
        const Bvh bvh = buildBvh(scale(boxes, factor));
        EXPECT_EQ(bvh.order, expected.order) << factor;
        EXPECT_DOUBLE_EQ(bvh.cost, expected.cost) << factor;
    }
}

struct Defect {
    const char* name;
    const char* sentence;  // a part of what is expected
    std::function<void(Bvh&, BvhNode& leaf)> corrupt;
};

void PrintTo(const Defect& defect, std::ostream* out) { *out << defect.name; }

class CheckBvh : public testing::TestWithParam<Defect> {};

TEST_P(CheckBvh, FindsTheDefect)
{
    const Boxes boxes = makeRandom(1000, 1.0F);
    Bvh bvh = buildBvh(boxes);
    ASSERT_FALSE(findBvhDefect(bvh, boxes));
    const auto leaf = std::find_if(bvh.nodes.begin(), bvh.nodes.end(), [](const BvhNode& node) { return node.count > 1; });
    ASSERT_NE(leaf, bvh.nodes.end());
    GetParam().corrupt(bvh, *leaf);
    const auto defect = findBvhDefect(bvh, boxes);
    ASSERT_TRUE(defect);
    EXPECT_NE(defect->find(GetParam().sentence), std::string::npos) << *defect;
}

// Replaces the tree by one path of `inner` inner nodes, each with one leaf of one primitive, under equal boxes.
void makePath(Bvh& bvh, std::uint32_t inner)
{
    const Box everything{glm::vec3(-3), glm::vec3(3)};
    const auto primitives = static_cast<std::uint32_t>(bvh.order.size());
    bvh.nodes.assign(1, {everything, 0, 0});
    for (std::uint32_t i = 0; i < inner; ++i) {
        bvh.nodes.back().first = 2 * i + 1;
        bvh.nodes.back().count = 0;
        bvh.nodes.push_back({everything, i, 1});
        bvh.nodes.push_back({everything, i + 1, primitives - i - 1});
    }
    bvh.depth = inner;
}

// Exchanges the children of two sibling nodes that have only leaves below.
void exchangeCousins(Bvh& bvh, BvhNode&)
{
    const auto isLeaf = [&](std::uint32_t i) { return bvh.nodes[i].count > 0; };
    const auto hasOnlyLeaves = [&](std::uint32_t i) { return !isLeaf(i) && isLeaf(bvh.nodes[i].first) && isLeaf(bvh.nodes[i].first + 1); };
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
        const std::uint32_t left = bvh.nodes[i].first;
        if (!isLeaf(i) && hasOnlyLeaves(left) && hasOnlyLeaves(left + 1)) {
            std::swap_ranges(&bvh.nodes[bvh.nodes[left].first], &bvh.nodes[bvh.nodes[left].first] + 2,
                             &bvh.nodes[bvh.nodes[left + 1].first]);
            std::swap(bvh.nodes[left].first, bvh.nodes[left + 1].first);
            return;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Every, CheckBvh,
    testing::Values(Defect{"NoNodes", "0 nodes", [](Bvh& bvh, BvhNode&) { bvh.nodes.clear(); }},
                    Defect{"ShortOrder", "expected 1000", [](Bvh& bvh, BvhNode&) { bvh.order.pop_back(); }},
                    Defect{"ChildBeforeParent", "has its children at", [](Bvh& bvh, BvhNode&) { bvh.nodes[1].first = 0; }},
                    Defect{"ChildBeyondTheEnd", "has its children at",
                           [](Bvh& bvh, BvhNode&) { bvh.nodes[1].first = static_cast<std::uint32_t>(bvh.nodes.size()) - 1; }},
                    Defect{"TwoParents", "two parents", [](Bvh& bvh, BvhNode&) { bvh.nodes[2].first = bvh.nodes[1].first; }},
                    Defect{"NotDepthFirst", "depth first they are at", exchangeCousins},
                    Defect{"Orphan", "no parent",
                           [](Bvh& bvh, BvhNode&) {
                               bvh.nodes.insert(bvh.nodes.end(), 2, {bvh.nodes[0].box, 0, 1});
                           }},
                    Defect{"LeafBeyondTheEnd", "beyond the 1000", [](Bvh&, BvhNode& leaf) { leaf.first = 999; }},
                    Defect{"UnknownPrimitive", "of only 1000", [](Bvh& bvh, BvhNode& leaf) { bvh.order[leaf.first] = 1000; }},
                    Defect{"PrimitiveTwice", "in a leaf before it",
                           [](Bvh& bvh, BvhNode& leaf) { bvh.order[leaf.first + 1] = bvh.order[leaf.first]; }},
                    Defect{"PrimitiveInNoLeaf", "is in no leaf", [](Bvh&, BvhNode& leaf) { --leaf.count; }},
                    Defect{"SmallLeafBox", "does not contain primitive", [](Bvh&, BvhNode& leaf) { leaf.box.hi = leaf.box.lo; }},
                    Defect{"SmallInnerBox", "that of its child",
                           [](Bvh& bvh, BvhNode&) { bvh.nodes[0].box.lo.x = std::nextafter(bvh.nodes[0].box.lo.x, 2.0F); }},
                    Defect{"NanBox", "does not contain", [](Bvh&, BvhNode& leaf) { leaf.box.lo.y = std::nanf(""); }},
                    Defect{"TooDeep", "more than the traversal stack holds", [](Bvh& bvh, BvhNode&) { makePath(bvh, kMaxBvhDepth + 1); }},
                    Defect{"WrongDepth", "but it says", [](Bvh& bvh, BvhNode&) { ++bvh.depth; }},
                    Defect{"WrongCost", "cost is", [](Bvh& bvh, BvhNode&) { bvh.cost *= 1.001; }},
                    Defect{"NanCost", "cost is", [](Bvh& bvh, BvhNode&) { bvh.cost = std::nan(""); }}),
    [](const auto& input) { return input.param.name; });

}  // namespace
}  // namespace glim
