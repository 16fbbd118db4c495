// The wide tree keeps the invariants of wide_bvh.hpp, and no other choice of nodes would be cheaper.
#include "host/bvh/collapse_bvh.hpp"
#include "host/bvh/build_bvh.hpp"
#include "host/bvh/refit_bvh.hpp"
#include "host/bvh/surface_area.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "shaders/shared/scene_types.h"
#include "tests/harness/random.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numeric>

namespace glim {
namespace {

using Kind = WideChild::Kind;

bool contains(const Box& outer, const Box& inner)
{
    return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) && glm::all(glm::lessThanEqual(inner.hi, outer.hi));
}

// What a walk over the whole tree finds.
struct Walked {
    std::vector<std::uint32_t> parents;  // of each node
    std::uint32_t depth = 0;
    double cost = 0.0;
};

class Walker {
public:
    Walker(const WideBvh& bvh, const std::vector<Box>& boxes)
        : bvh_(bvh),
          boxes_(boxes),
          area_(computeHalfArea(bvh.box)),
          walked_{std::vector<std::uint32_t>(bvh.nodes.size(), 0)}
    {}

    Walked walk()
    {
        visit(0, bvh_.box, 1);
        return std::move(walked_);
    }

private:
    void visit(std::uint32_t index, const Box& box, std::uint32_t depth)
    {
        walked_.depth = std::max(walked_.depth, depth);
        walked_.cost += computeHalfArea(box) / area_;
        std::uint32_t nextNode = 0, nextEntry = 0;  // 0: any
        for (const WideChild& child : bvh_.nodes[index].children) {
            if (child.kind == Kind::Inner) {
                EXPECT_GT(child.first, index);
                EXPECT_TRUE(nextNode == 0 || child.first == nextNode) << "node " << index;
                nextNode = child.first + 1;
                ++walked_.parents.at(child.first);
                EXPECT_TRUE(contains(box, child.box));
                visit(child.first, child.box, depth + 1);
            } else if (child.kind == Kind::Leaf) {
                EXPECT_TRUE(nextEntry == 0 || child.first == nextEntry) << "node " << index;
                nextEntry = child.first + child.count;
                EXPECT_TRUE(child.count >= 1 && child.count <= kMaxLeafRefs) << child.count;
                walked_.cost += computeHalfArea(child.box) / area_ * child.count;
                for (std::uint32_t i = child.first; i < nextEntry; ++i) {
                    EXPECT_TRUE(contains(child.box, boxes_[bvh_.order.at(i)]));
                }
            }
        }
    }

    const WideBvh& bvh_;
    const std::vector<Box>& boxes_;
    double area_;
    Walked walked_;
};

TEST(CollapseBvhTest, KeepsItsInvariants)
{
    for (const Triangles& mesh : {icosphere(0), terrain(40), terrain(120), randomTriangles(3000, 0.1F, 1), growingLine(5000, 1e-4F, 1.001),
                                  coincidentTriangles(1000)}) {
        const std::vector<Box> boxes = primitiveBoxes(makeTestPrimitives(mesh));
        for (const SplitRule rule : {SplitRule::Sah, SplitRule::Mean, SplitRule::Median}) {
            const WideBvh wide = collapseBvh(buildBvh(boxes, rule));
            const Walked walked = Walker(wide, boxes).walk();
            EXPECT_EQ(std::count(walked.parents.begin() + 1, walked.parents.end(), 1U), static_cast<std::ptrdiff_t>(wide.nodes.size()) - 1);
            EXPECT_EQ(wide.depth, walked.depth);
            EXPECT_LE(wide.depth, kMaxWideDepth);
            EXPECT_NEAR(wide.cost, walked.cost, 1e-9 * walked.cost);
            std::vector<std::uint32_t> order = wide.order, all(boxes.size());
            std::sort(order.begin(), order.end());
            std::iota(all.begin(), all.end(), 0U);
            EXPECT_EQ(order, all);
        }
    }
}

// A cloud that is too large for one part, in a box, with a sphere and a line.
Scene makeCloudScene(std::size_t points)
{
    Random random(3);
    Scene scene = makeTestScene(terrain(40), {{"", glm::vec3(0.0F), 0.1F, 0}});
    const auto addCloud = [&scene](std::size_t count, const auto& place, std::vector<glm::uvec2> lines) {
        Mesh cloud;
        cloud.isCloud = true;
        cloud.pointRadius = 0.002;
        cloud.lines = std::move(lines);
        for (std::size_t i = 0; i < count; ++i) {
            cloud.positions.push_back(place());
        }
        scene.instances.push_back({"", static_cast<std::uint32_t>(scene.meshes.size())});
        scene.meshes.change().push_back(std::move(cloud));
    };
    addCloud(points, [&] { return glm::dvec3(random.direction()) * (1.0 + 0.3 * glm::dvec3(random.direction()).x); }, {});
    addCloud(2, [&] { return glm::dvec3(random.direction()); }, {{0, 1}});
    return scene;
}

constexpr std::size_t kCloud = 300'000;

TEST(PointPartsTest, EachPointIsInOneLeaf)
{
    for (const std::uint64_t maxFlat : {kMaxFlatTriangles, std::uint64_t{0}}) {
        const Scene scene = makeCloudScene(kCloud);
        const Primitives primitives = makePrimitives(scene, maxFlat);
        ASSERT_GE(primitives.count(), kCloud + 2);
        const std::vector<Box> boxes = primitiveBoxes(primitives);
        for (const SplitRule rule : {SplitRule::Sah, SplitRule::Mean, SplitRule::Median}) {
            const WideBvh wide = buildSceneBvh(primitives, rule);
            const Walked walked = Walker(wide, boxes).walk();
            EXPECT_LE(wide.depth, kMaxWideDepth);
            const std::size_t ofTop = wide.meshTrees.empty() ? wide.order.size() : wide.meshTrees[0].firstEntry;
            std::vector<std::uint32_t> order(wide.order.begin(), wide.order.begin() + static_cast<std::ptrdiff_t>(ofTop));
            std::vector<std::uint32_t> all(primitives.count());
            std::ranges::sort(order);
            std::iota(all.begin(), all.end(), 0U);
            EXPECT_EQ(order, all);
            if (wide.meshTrees.empty()) {
                EXPECT_EQ(wide.depth, walked.depth);
                EXPECT_NEAR(wide.cost, walked.cost, 1e-9 * walked.cost);
                EXPECT_EQ(std::count(walked.parents.begin() + 1, walked.parents.end(), 1U),
                          static_cast<std::ptrdiff_t>(wide.nodes.size()) - 1);
            }
        }
    }
}

TEST(PointPartsTest, TheTreeCostsLittleMoreThanOneThatIsBuiltAtOnce)
{
    Scene scene = makeCloudScene(kCloud);
    scene.spheres.clear();
    scene.instances = {scene.instances[1]};  // the points alone
    const Primitives primitives = makePrimitives(scene);
    const double inParts = buildSceneBvh(primitives).cost, atOnce = collapseBvh(buildBvh(primitiveBoxes(primitives))).cost;
    std::cout << "cost in parts over cost at once: " << inParts / atOnce << "\n";
    EXPECT_LT(inParts, 1.05 * atOnce);
}

// A reference has 48 bytes, a node 80 on the device and 288 before it is packed; an index has 4. Nodes hold at least five primitives.
TEST(PointPartsTest, APointTakesTensOfBytes)
{
    const Scene scene = makeCloudScene(kCloud);
    const Primitives primitives = makePrimitives(scene);
    WideBvh bvh = buildSceneBvh(primitives);
    const FlatScene kept = flattenScene(scene, primitives, bvh);
    const auto perPoint = [&](std::size_t bytes) { return static_cast<double>(bytes) / static_cast<double>(primitives.count()); };
    const double tree = perPoint(bvh.nodes.size() * sizeof(WideNode) + bvh.order.size() * sizeof(std::uint32_t));
    const double flat = perPoint(sizeInBytes(kept));
    std::cout << "bytes a point: tree " << tree << ", flat scene " << flat << "\n";
    EXPECT_LT(tree, 288.0 / 5.0 + 4.0);
    EXPECT_LT(flat, 80.0 / 5.0 + 48.0);
    const FlatScene freed = flattenScene(scene, primitives, std::move(bvh));
    EXPECT_EQ(bvh.nodes.capacity(), 0U);  // NOLINT(bugprone-use-after-move): says what it does with it
    EXPECT_EQ(freed.nodes, kept.nodes);
    EXPECT_EQ(freed.primitiveRefs, kept.primitiveRefs);
    EXPECT_EQ(freed.features, kept.features);
}

// The refitted tree is one over the boxes where they are now, and its cost is what a walk finds.
TEST(RefitBvhTest, KeepsTheInvariants)
{
    Random random(5);
    for (const SplitRule rule : {SplitRule::Sah, SplitRule::Median}) {
        std::vector<Box> boxes = primitiveBoxes(makeTestPrimitives(randomTriangles(3000, 0.1F, 1)));
        const WideBvh built = collapseBvh(buildBvh(boxes, rule));
        for (Box& box : boxes) {
            const glm::vec3 step = 0.1F * glm::vec3(random.direction());
            box = {box.lo + step, box.hi + step};
        }
        const std::optional<WideBvh> refitted = refitBvh(built, boxes, 1e9);
        ASSERT_TRUE(refitted);
        EXPECT_EQ(refitted->order, built.order);
        EXPECT_EQ(refitted->cost, built.cost);
        const Walked walked = Walker(*refitted, boxes).walk();
        EXPECT_GT(walked.cost, built.cost);
        EXPECT_TRUE(refitBvh(built, boxes, 1.001 * walked.cost / built.cost));
        EXPECT_FALSE(refitBvh(built, boxes, 0.999 * walked.cost / built.cost));
    }
}

TEST(RefitBvhTest, IsBuiltAgainIfTooCostly)
{
    Triangles mesh = randomTriangles(3000, 0.1F, 1);
    const Primitives before = makeTestPrimitives(mesh);
    std::ranges::reverse(mesh);
    const Primitives after = makeTestPrimitives(mesh);
    const WideBvh built = buildSceneBvh(before);
    EXPECT_EQ(updateSceneBvh(built, before, after).order, buildSceneBvh(after).order);
    EXPECT_NE(built.order, buildSceneBvh(after).order);
}

// A path of kMaxBvhDepth inner nodes that shrink. Each has seven leaves on its left side, as large as itself. The cheapest wide
// tree has a node for each, which holds these leaves and the next node.
class LongPath {
public:
    Bvh make()
    {
        bvh_.depth = kMaxBvhDepth;
        bvh_.nodes.resize(1);
        std::uint32_t node = 0;
        float size = 1.0F;
        for (std::uint32_t depth = 0; depth < kMaxBvhDepth; ++depth) {
            const std::uint32_t first = divide(node, size);
            addLeaves(first, size, depth + 4 <= kMaxBvhDepth ? 7 : 1);
            node = first + 1;
            size *= 0.9F;
        }
        addLeaves(node, size, 1);
        return std::move(bvh_);
    }

private:
    std::uint32_t divide(std::uint32_t node, float size)
    {
        const auto first = static_cast<std::uint32_t>(bvh_.nodes.size());
        bvh_.nodes[node] = {Box{glm::vec3(0.0F), glm::vec3(size)}, first, 0};
        bvh_.nodes.resize(first + 2);
        return first;
    }

    void addLeaves(std::uint32_t node, float size, std::uint32_t count)
    {
        if (count == 1) {  // of two primitives, so that no two make one
            const auto first = static_cast<std::uint32_t>(bvh_.order.size());
            bvh_.nodes[node] = {Box{glm::vec3(0.0F), glm::vec3(size)}, first, 2};
            bvh_.order.insert(bvh_.order.end(), {first, first + 1});
            return;
        }
        const std::uint32_t first = divide(node, size);
        addLeaves(first, size, count / 2);
        addLeaves(first + 1, size, count - count / 2);
    }

    Bvh bvh_;
};

TEST(CollapseBvhTest, NoTreeIsDeeperThanTheStack)
{
    const Bvh bvh = LongPath().make();
    const WideBvh wide = collapseBvh(bvh);
    const std::vector<Box> boxes(bvh.order.size(), Box{glm::vec3(0.0F), glm::vec3(1e-3F)});
    EXPECT_EQ(Walker(wide, boxes).walk().depth, wide.depth);
    EXPECT_LE(wide.depth, kMaxWideDepth);
    EXPECT_GT(wide.depth, (kMaxBvhDepth + 2) / 3) << "the cheapest nodes for as long as they may";
    EXPECT_EQ(wide.order.size(), bvh.order.size());
}

TEST(CollapseBvhTest, FewPrimitivesAreOneNode)
{
    for (std::uint32_t count = 1; count <= 8; ++count) {
        std::vector<Box> boxes;
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::vec3 lo(10.0F * static_cast<float>(i & 1U), 10.0F * static_cast<float>(i >> 1 & 1U),
                               10.0F * static_cast<float>(i >> 2));
            boxes.push_back({lo, lo + 1.0F});
        }
        const WideBvh wide = collapseBvh(buildBvh(boxes));
        ASSERT_EQ(wide.nodes.size(), 1U);
        for (std::uint32_t place = 0; place < kBvhWidth && count == 8; ++place) {
            const WideChild& child = wide.nodes[0].children[place];
            EXPECT_EQ(child.kind, Kind::Leaf);
            EXPECT_EQ(wide.order[child.first], place) << "each in the octant that it lies in";
        }
    }
}

// --- the least cost, by trying everything ---

class MinCost {
public:
    explicit MinCost(const Bvh& bvh)
        : bvh_(bvh)
    {}

    double find() const { return ofNode(0); }

private:
    static constexpr double kPrimitive = 0.5;

    std::uint32_t countOf(std::uint32_t i) const
    {
        const BvhNode& node = bvh_.nodes[i];
        return node.count > 0 ? node.count : countOf(node.first) + countOf(node.first + 1);
    }
    double area(std::uint32_t i) const { return computeHalfArea(bvh_.nodes[i].box); }
    double asLeaf(std::uint32_t i) const { return countOf(i) <= kMaxLeafRefs ? area(i) * countOf(i) * kPrimitive : 1e300; }

    // The least cost of this subtree as a child of another node.
    double ofRoot(std::uint32_t i) const { return bvh_.nodes[i].count > 0 ? asLeaf(i) : std::min(asLeaf(i), ofNode(i)); }

    double ofNode(std::uint32_t i) const { return area(i) + (bvh_.nodes[i].count > 0 ? asLeaf(i) : ofForest(i, kBvhWidth, true)); }

    // The least cost of this subtree as at most `roots` children of a node.
    double ofForest(std::uint32_t i, std::uint32_t roots, bool mustOpen) const
    {
        double least = mustOpen ? 1e300 : ofRoot(i);
        for (std::uint32_t k = 1; k < roots && bvh_.nodes[i].count == 0; ++k) {
            const std::uint32_t first = bvh_.nodes[i].first;
            least = std::min(least, ofForest(first, k, false) + ofForest(first + 1, roots - k, false));
        }
        return least;
    }

    const Bvh& bvh_;
};

double computeCost(const WideBvh& wide)
{
    double cost = computeHalfArea(wide.box);
    for (const WideNode& node : wide.nodes) {
        for (const WideChild& child : node.children) {
            cost += child.kind == Kind::Inner ? computeHalfArea(child.box) : 0.0;
            cost += child.kind == Kind::Leaf ? computeHalfArea(child.box) * child.count * 0.5 : 0.0;
        }
    }
    return cost;
}

TEST(CollapseBvhTest, NoOtherChoiceIsCheaper)
{
    Random random(6);
    for (const std::uint32_t count : {2U, 5U, 9U, 12U, 14U}) {
        for (int round = 0; round < 4; ++round) {
            std::vector<Box> boxes;
            for (std::uint32_t i = 0; i < count; ++i) {
                const glm::vec3 lo(random.normalVector());
                boxes.push_back({lo, lo + glm::abs(glm::vec3(random.normalVector()))});
            }
            const Bvh bvh = buildBvh(boxes);
            const double least = MinCost(bvh).find();
            EXPECT_NEAR(computeCost(collapseBvh(bvh)), least, 1e-5 * least) << count;
        }
    }
}

}  // namespace
}  // namespace glim
