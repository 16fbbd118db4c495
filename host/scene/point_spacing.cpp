#include "host/scene/point_spacing.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>

namespace glim {
namespace {

constexpr std::size_t kMaxSampled = 1024;
constexpr std::size_t kLeaf = 16;  // points that are compared one by one

using Points = std::span<glm::dvec3>;

int longestAxis(Points points)
{
    glm::dvec3 low(points.front()), high(low);
    for (const glm::dvec3& point : points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    const glm::dvec3 side = high - low;
    return side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
}

// A k-d tree in place: the middle point of a range divides the others by an axis.
class Tree {
public:
    explicit Tree(Points points)
        : points_(points),
          axes_(points.size())
    {
        build(points_);
    }

    // The square of the distance to the nearest point at another place.
    double nearest(const glm::dvec3& place) const
    {
        double square = std::numeric_limits<double>::infinity();
        search(points_, place, square);
        return square;
    }

private:
    static Points before(Points range) { return range.first(range.size() / 2); }
    static Points behind(Points range) { return range.subspan(range.size() / 2 + 1); }
    static glm::dvec3& middle(Points range) { return range[range.size() / 2]; }
    signed char& axisOf(Points range) { return axes_[static_cast<std::size_t>(&middle(range) - points_.data())]; }
    int axisOf(Points range) const { return axes_[static_cast<std::size_t>(&middle(range) - points_.data())]; }

    void build(Points range)
    {
        if (range.size() <= kLeaf) {
            return;
        }
        const int axis = longestAxis(range);
        axisOf(range) = static_cast<signed char>(axis);
        std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2), {},
                                 [axis](const glm::dvec3& point) { return point[axis]; });
        build(before(range));
        build(behind(range));
    }

    static void compare(const glm::dvec3& point, const glm::dvec3& place, double& square)
    {
        const glm::dvec3 apart = point - place;
        square = point == place ? square : std::min(square, glm::dot(apart, apart));
    }

    void search(Points range, const glm::dvec3& place, double& square) const
    {
        if (range.size() <= kLeaf) {
            for (const glm::dvec3& point : range) {
                compare(point, place, square);
            }
            return;
        }
        compare(middle(range), place, square);
        const double beyond = place[axisOf(range)] - middle(range)[axisOf(range)];
        search(beyond < 0.0 ? before(range) : behind(range), place, square);
        if (beyond * beyond < square) {
            search(beyond < 0.0 ? behind(range) : before(range), place, square);
        }
    }

    Points points_;
    std::vector<signed char> axes_;  // by point
};

}  // namespace

double computePointSpacing(std::vector<glm::dvec3> points)
{
    // Each place once: then no point has many others at its own place to pass.
    std::ranges::sort(points, {}, [](const glm::dvec3& point) { return std::tuple(point.x, point.y, point.z); });
    points.erase(std::ranges::unique(points).begin(), points.end());
    if (points.size() < 2) {
        return 0.0;
    }
    const std::size_t step = (points.size() + kMaxSampled - 1) / kMaxSampled;
    std::vector<glm::dvec3> sampled;
    for (std::size_t i = 0; i < points.size(); i += step) {
        sampled.push_back(points[i]);
    }
    const Tree tree(points);
    std::vector<double> squares;
    for (const glm::dvec3& place : sampled) {
        squares.push_back(tree.nearest(place));
    }
    const auto median = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
    std::ranges::nth_element(squares, median);
    return std::sqrt(*median);
}

}  // namespace glim
