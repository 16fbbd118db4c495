// The distance to the nearest neighbour in a cloud of points.
#include "host/scene/point_spacing.hpp"
#include "tests/harness/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace glim {
namespace {

std::vector<glm::dvec3> randomPoints(std::size_t count, const glm::dvec3& size)
{
    Random random(3);
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(size * glm::dvec3(random.unitFloat(), random.unitFloat(), random.unitFloat()));
    }
    return points;
}

// By all pairs.
double spacingByPairs(const std::vector<glm::dvec3>& points)
{
    std::vector<double> distances;
    for (const glm::dvec3& point : points) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& other : points) {
            nearest = other == point ? nearest : std::min(nearest, glm::distance(point, other));
        }
        distances.push_back(nearest);
    }
    std::ranges::sort(distances);
    return distances[distances.size() / 2];
}

TEST(PointSpacing, IsTheMedianOverAllPairs)
{
    for (const glm::dvec3& size : {glm::dvec3(1.0), glm::dvec3(1e3, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1e-3)}) {
        const std::vector<glm::dvec3> points = randomPoints(1000, size);
        EXPECT_DOUBLE_EQ(computePointSpacing(points), spacingByPairs(points)) << size.x;
    }
}

TEST(PointSpacing, OfAGridIsItsStepHoweverManyPointsAreSampled)
{
    std::vector<glm::dvec3> grid;
    for (int i = 0; i < 64 * 64 * 4; ++i) {
        grid.emplace_back(0.25 * (i % 64), 0.25 * (i / 64 % 64), 2.0 * (i / 4096));
    }
    EXPECT_EQ(computePointSpacing(grid), 0.25);
    std::ranges::reverse(grid);
    EXPECT_EQ(computePointSpacing(grid), 0.25);
}

TEST(PointSpacing, CopiesOfAPointAreNotItsNeighbours)
{
    std::vector<glm::dvec3> points(1000, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(computePointSpacing(points), 0.0);
    points.emplace_back(1.0, 2.0, 7.0);
    EXPECT_EQ(computePointSpacing(points), 4.0);
    EXPECT_EQ(computePointSpacing({}), 0.0);
}

}  // namespace
}  // namespace glim
