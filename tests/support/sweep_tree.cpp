#include "tests/support/sweep_tree.hpp"

#include "host/bvh/surface_area.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace glim {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

Box join(const Box& a, const Box& b) { return {glm::min(a.lo, b.lo), glm::max(a.hi, b.hi)}; }

struct Place {
    double weight = kNever;  // sum over both sides of half area * boxes
    std::size_t left = 0;
};

Place findBestPlace(const std::vector<Box>& sorted)
{
    std::vector<double> rightWeights(sorted.size());
    Box right = sorted.back();
    for (std::size_t i = sorted.size(); --i > 0;) {
        right = join(right, sorted[i]);
        rightWeights[i] = computeHalfArea(right) * static_cast<double>(sorted.size() - i);
    }
    Place best;
    Box left = sorted.front();
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        left = join(left, sorted[i - 1]);
        const double weight = computeHalfArea(left) * static_cast<double>(i) + rightWeights[i];
        best = weight < best.weight ? Place{weight, i} : best;
    }
    return best;
}

double areaOf(const std::vector<Box>& boxes)
{
    Box all = boxes.front();
    for (const Box& box : boxes) {
        all = join(all, box);
    }
    return computeHalfArea(all);
}

// Cost times the half area of the root.
double computeWeight(std::vector<Box> boxes)
{
    const double area = areaOf(boxes), count = static_cast<double>(boxes.size());
    Place best;
    std::vector<Box> sorted;
    for (int axis = 0; axis < 3 && boxes.size() > 1; ++axis) {
        std::stable_sort(boxes.begin(), boxes.end(),
                         [axis](const Box& a, const Box& b) { return computeCentre(a)[axis] < computeCentre(b)[axis]; });
        const Place place = findBestPlace(boxes);
        if (place.weight < best.weight) {
            best = place;
            sorted = boxes;
        }
    }
    if (boxes.size() == 1 || (boxes.size() == 2 && area + best.weight >= area * count)) {
        return area * count;
    }
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(best.left);
    return area + computeWeight({sorted.begin(), middle}) + computeWeight({middle, sorted.end()});
}

}  // namespace

double computeSweepCost(std::span<const Box> boxes)
{
    const std::vector<Box> all(boxes.begin(), boxes.end());
    return computeWeight(all) / areaOf(all);
}

}  // namespace glim
