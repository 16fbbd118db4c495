// H6: the depth of trees over primitives that cannot be split and over primitives of growing size, compared with splits in the middle.
#include "host/bvh/build_bvh.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace glim {
namespace {

struct Shape {
    std::uint32_t depth = 0, largestLeaf = 0;

    bool isWithinLimits() const { return depth <= kMaxBvhDepth && largestLeaf <= 4; }
    std::string text() const { return "depth " + std::to_string(depth) + ", leaves of " + std::to_string(largestLeaf); }
};

Shape shapeOf(const Bvh& bvh)
{
    Shape shape{bvh.depth, 0};
    for (const BvhNode& node : bvh.nodes) {
        shape.largestLeaf = std::max(shape.largestLeaf, node.count);
    }
    return shape;
}

// A node is a leaf if it is small enough or cannot be split.
void splitInTheMiddle(const std::vector<double>& ascending, std::size_t begin, std::size_t end, std::uint32_t depth, Shape& shape)
{
    const double middle = 0.5 * (ascending[begin] + ascending[end - 1]);
    const auto first = ascending.begin();
    const auto right = static_cast<std::size_t>(
        std::lower_bound(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end), middle) - first);
    if (end - begin <= 4 || right == begin || right == end) {
        shape = {std::max(shape.depth, depth), std::max(shape.largestLeaf, static_cast<std::uint32_t>(end - begin))};
        return;
    }
    splitInTheMiddle(ascending, begin, right, depth + 1, shape);
    splitInTheMiddle(ascending, right, end, depth + 1, shape);
}

TEST(BvhDepthTest, H6DepthFitsTheStack)
{
    for (const auto& [name, mesh] : {std::pair{"100,000 coincident triangles", coincidentTriangles(100000)},
                                     {"100,000 in a row, sizes over 43 decades", growingLine(100000, 1e-30F, 1.001)}}) {
        const std::vector<Box> boxes = primitiveBoxes(makeTestPrimitives(mesh));
        std::vector<double> centres;
        for (const Box& box : boxes) {
            centres.push_back(0.5 * static_cast<double>(box.lo.x) + 0.5 * static_cast<double>(box.hi.x));
        }
        Shape naive;
        splitInTheMiddle(centres, 0, centres.size(), 0, naive);
        const Shape shape = shapeOf(buildBvh(boxes));
        printHardCase("H6", name, 1, shape.text(), "splits in the middle: " + naive.text());
        EXPECT_TRUE(shape.isWithinLimits());
        EXPECT_FALSE(naive.isWithinLimits());
    }
}

}  // namespace
}  // namespace glim
