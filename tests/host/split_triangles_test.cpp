// Pieces hold their triangles and waste less; a tree is made of them where that is cheaper, and holds every primitive.
#include "host/flatten/split_triangles.hpp"
#include "host/bvh/build_bvh.hpp"
#include "host/bvh/collapse_bvh.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

namespace glim {
namespace {

// Rounding in double may move a point of an axis-aligned triangle this far off the triangle and out of its flat box.
constexpr double kRounding = 1e-14;

bool holds(const Box& box, const glm::dvec3& point)
{
    return glm::all(glm::greaterThanEqual(point, glm::dvec3(box.lo) - kRounding)) &&
           glm::all(glm::lessThanEqual(point, glm::dvec3(box.hi) + kRounding));
}

double sizeOf(const Box& box)
{
    const glm::dvec3 size = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return std::max({size.x, size.y, size.z});
}

// Up to the margin by which the boxes of pieces grow.
bool holds(const Box& box, const Box& inner)
{
    const double margin = 0x1p-21 * sizeOf(box);
    return glm::all(glm::greaterThanEqual(glm::dvec3(inner.lo), glm::dvec3(box.lo) - margin)) &&
           glm::all(glm::lessThanEqual(glm::dvec3(inner.hi), glm::dvec3(box.hi) + margin)) &&
           glm::all(glm::lessThanEqual(inner.lo, inner.hi));
}

double halfArea(const Box& box)
{
    const glm::dvec3 size = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

// A point of the triangle, moved by up to `margin` along each axis.
glm::dvec3 pointOf(const Triangle& triangle, Random& random, double margin = 0.0)
{
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    // Every eighth on an edge.
    v = random.below(8) == 0 ? 0.0 : v;
    const glm::dvec3 v0(triangle.vertices[0]);
    const glm::dvec3 beside(random.uniform(-margin, margin), random.uniform(-margin, margin), random.uniform(-margin, margin));
    return v0 + u * (glm::dvec3(triangle.vertices[1]) - v0) + v * (glm::dvec3(triangle.vertices[2]) - v0) + beside;
}

std::vector<std::vector<Box>> byPrimitive(const Pieces& pieces, std::size_t count)
{
    std::vector<std::vector<Box>> boxes(count);
    for (std::size_t i = 0; i < pieces.boxes.size(); ++i) {
        boxes.at(pieces.primitives[i]).push_back(pieces.boxes[i]);
    }
    return boxes;
}

// Among other triangles, an axis-aligned one and ones without area.
Triangles awkward()
{
    Triangles mesh = strips(10, 3);
    mesh.push_back({{{-1, -1, 0.25F}, {1, -1, 0.25F}, {1, 1, 0.25F}}});
    mesh.push_back({{{-1, -1, -1}, {0, 0, 0}, {1, 1, 1}}});
    mesh.push_back({{{-1, -1, -1}, {-1, -1, -1}, {1, 0.9F, 1}}});
    mesh.push_back({{{0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F}}});
    return mesh;
}

// They also hold what the test of a ray that starts nearby takes for the triangle: points up to 2^-23 of its size beside it are tried,
// twice as far as that test errs.
TEST(SplitTrianglesTest, PiecesHoldTheirTriangles)
{
    for (const float scale : {1.0F, 0x1p-50F, 0x1p50F, 0x1p127F}) {
        for (const Triangles& mesh : {awkward(), strips(40, 5)}) {
            const Primitives primitives =
                makeTestPrimitives(placed(mesh, scale, 0.0F), scale == 1.0F ? randomSpheres(30, 0.5F, 6) : std::vector<Sphere>{});
            const std::vector<Box> whole = primitiveBoxes(primitives);
            const Pieces pieces = splitTriangles(primitives.triangles, whole);
            ASSERT_FALSE(pieces.boxes.empty());
            const auto boxes = byPrimitive(pieces, whole.size());
            Random random(7);
            for (std::size_t id = 0; id < whole.size(); ++id) {
                ASSERT_FALSE(boxes[id].empty());
                for (const Box& box : boxes[id]) {
                    ASSERT_TRUE(holds(whole[id], box)) << "triangle " << id << " of " << mesh.size();
                }
                const double margin = boxes[id].size() > 1 ? 0x1p-23 * sizeOf(whole[id]) / static_cast<double>(scale) : 0.0;
                for (int i = 0; i < 100 && id < mesh.size(); ++i) {
                    const glm::dvec3 point = pointOf(mesh[id], random, margin);
                    const bool held = std::any_of(boxes[id].begin(), boxes[id].end(), [&](const Box& box) {
                        return holds({box.lo / scale, box.hi / scale}, point);
                    });
                    ASSERT_TRUE(held) << "triangle " << id << " of " << mesh.size() << ", scale " << scale;
                }
            }
        }
    }
}

TEST(SplitTrianglesTest, ATenthMoreAtMostAndTheWorstFirst)
{
    const Primitives primitives = makeTestPrimitives(strips(12, 9));
    const std::vector<Box> whole = primitiveBoxes(primitives);
    const Pieces pieces = splitTriangles(primitives.triangles, whole);
    EXPECT_EQ(pieces.boxes.size(), whole.size() + whole.size() / 10);
    const auto boxes = byPrimitive(pieces, whole.size());
    double minSplit = 1e300, greatestLeft = 0.0, before = 0.0, after = 0.0;
    for (std::size_t id = 0; id < whole.size(); ++id) {
        EXPECT_TRUE(boxes[id].size() == 1 || id >= 12 * 40) << "only strips waste so much, triangle " << id;
        minSplit = boxes[id].size() > 1 ? std::min(minSplit, halfArea(whole[id])) : minSplit;
        before += halfArea(whole[id]);
        for (const Box& box : boxes[id]) {
            greatestLeft = std::max(greatestLeft, halfArea(box));
            after += halfArea(box);
        }
    }
    std::cout << "half the surface of all boxes " << before << ", of pieces' " << after << "; the least divided " << minSplit
              << ", the greatest left " << greatestLeft << "\n";
    EXPECT_LT(after, 0.5 * before);
    // A strip's box is all waste, but for some hundredths.
    EXPECT_LT(greatestLeft, 1.05 * minSplit);
}

TEST(SplitTrianglesTest, NothingIsSplitWhereLittleWastes)
{
    Triangles roofed = terrain(40);
    roofed.push_back({{{-10, 5, -10}, {10, 5, -10}, {10, 9, 10}}});  // makes 57 more, of which less than a fiftieth are no reason
    for (const Primitives& primitives :
         {makeTestPrimitives(roofed), makeTestPrimitives(terrain(300)), makeTestPrimitives(icosphere(4)),
          makeTestPrimitives({}, randomSpheres(50, 1.0F, 3)), makeTestPrimitives(randomTriangles(9, 1.0F, 2)),
          makeTestPrimitives(coincidentTriangles(1)), makeTestPrimitives(Triangles(20, Triangle{}))}) {
        EXPECT_TRUE(splitTriangles(primitives.triangles, primitiveBoxes(primitives)).boxes.empty())
            << primitives.triangles.size() << " triangles";
    }
}

// Some leaf that holds `primitive`, and every node above it, holds the point.
bool reaches(const WideBvh& bvh, std::uint32_t primitive, const glm::dvec3& point)
{
    std::vector<std::uint32_t> nodes{0};
    while (!nodes.empty()) {
        const WideNode& node = bvh.nodes[nodes.back()];
        nodes.pop_back();
        for (const WideChild& child : node.children) {
            if (child.kind == WideChild::Kind::Nothing || !holds(child.box, point)) {
                continue;
            }
            const auto first = bvh.order.begin() + child.first;
            if (child.kind == WideChild::Kind::Inner) {
                nodes.push_back(child.first);
            } else if (std::find(first, first + child.count, primitive) != first + child.count) {
                return true;
            }
        }
    }
    return false;
}

double computeCost(const std::vector<Box>& boxes) { return collapseBvh(buildBvh(boxes)).cost; }

TEST(SceneBvhTest, IsOfPiecesWhereThatIsCheaper)
{
    const Primitives primitives = makeTestPrimitives(strips(12, 9));
    const WideBvh whole = collapseBvh(buildBvh(primitiveBoxes(primitives))), bvh = buildSceneBvh(primitives);
    std::cout << "cost of primitives " << whole.cost << ", of pieces " << bvh.cost << "\n";
    EXPECT_LT(bvh.cost, 0.9 * whole.cost);
    EXPECT_EQ(bvh.box.lo, whole.box.lo);
    EXPECT_EQ(bvh.box.hi, whole.box.hi);
    EXPECT_EQ(bvh.order.size(), primitives.triangles.size() + primitives.triangles.size() / 10);
    Random random(8);
    for (std::uint32_t id = 0; id < primitives.triangles.size(); ++id) {
        for (int i = 0; i < 100; ++i) {
            ASSERT_TRUE(reaches(bvh, id, pointOf(primitives.triangles[id], random))) << "triangle " << id;
        }
    }
}

TEST(SceneBvhTest, IsOfPrimitivesElsewhere)
{
    SceneBuilder builder;
    Primitives room = makePrimitives(builder.cube(1.5F, builder.lambert(glm::vec3(0.5F)), true).scene());
    const Triangles ball = icosphere(2);
    room.triangles.insert(room.triangles.end(), ball.begin(), ball.end());
    EXPECT_FALSE(splitTriangles(room.triangles, primitiveBoxes(room)).boxes.empty()) << "walls, but that does not pay";
    Triangles mixed = randomTriangles(500, 0.1F, 5);
    const Triangles larger = randomTriangles(100, 0.4F, 77);
    mixed.insert(mixed.end(), larger.begin(), larger.end());
    const std::vector<Box> boxes = primitiveBoxes(makeTestPrimitives(mixed));
    const double gain = computeCost(splitTriangles(mixed, boxes).boxes) / computeCost(boxes);
    EXPECT_GT(gain, 0.9);
    EXPECT_LT(gain, 0.97) << "a little cheaper";
    for (const Primitives& primitives : {makeTestPrimitives(terrain(50), randomSpheres(20, 0.5F, 4)), room, makeTestPrimitives(mixed)}) {
        const WideBvh whole = collapseBvh(buildBvh(primitiveBoxes(primitives))), bvh = buildSceneBvh(primitives);
        EXPECT_EQ(bvh.order, whole.order);
        EXPECT_EQ(bvh.cost, whole.cost);
    }
}

}  // namespace
}  // namespace glim
