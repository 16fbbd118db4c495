#include "host/flatten/split_triangles.hpp"

#include "host/bvh/surface_area.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <span>

namespace glim {
namespace {

// A box is split if it wastes more area than this many boxes of mean size. Triangles of about one size do not waste as much. Smaller
// limits lower a tree's cost by .02 at most.
constexpr double kMinWaste = 2.0;
// At most one extra piece per 10 primitives, and at least one per 50. Two or three times as many pieces lower a tree's cost by .03. If
// there are fewer than the minimum, they are of the walls and the light around the actual subject, and splitting those does not pay
// (tests/bench/EXPERIMENTS.md).
constexpr std::size_t kMaxSplitShare = 10, kMinSplitShare = 50;

// Candidate split planes per axis, a power of two. Boxes that are split by the same plane do not overlap across it.
constexpr std::uint32_t kPlanes = 1U << 20;

// How much the boxes of pieces grow, relative to the triangle's size. For rays that start nearby, the intersection test accepts hits
// beside the triangle by some 2^-24 of its size. The padding of nodes around whole triangles covers that (kPlanePad); nodes around pieces
// are smaller. Without this margin, 10 of 2.4 million rays from near the edges of split floors and walls missed what testing every
// triangle finds; with a quarter of it none did.
constexpr double kCutMargin = 0x1p-22;

// A triangle that is clipped by six planes has nine corners at most, or 28 if rounding has bent it so much that each plane cuts as many
// sides as it can.
struct Polygon {
    std::array<glm::dvec3, 28> corners;
    std::size_t count = 0;

    void add(const glm::dvec3& corner) { corners[count++] = corner; }
};

// The part above (sign 1) or below (-1) an axis-parallel plane (I. Sutherland, G. Hodgman, Reentrant Polygon Clipping, 1974).
Polygon clip(const Polygon& polygon, int axis, double plane, double sign)
{
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
        const double here = sign * (a[axis] - plane), next = sign * (b[axis] - plane);
        if (here >= 0.0) {
            kept.add(a);
        }
        if ((here > 0.0 && next < 0.0) || (here < 0.0 && next > 0.0)) {
            glm::dvec3 crossing = a + (b - a) * (here / (here - next));
            crossing[axis] = plane;
            kept.add(crossing);
        }
    }
    return kept;
}

Polygon clip(const Triangle& triangle, const Box& box)
{
    Polygon polygon;
    for (const glm::vec3& vertex : triangle.vertices) {
        polygon.add(vertex);
    }
    for (int axis = 0; axis < 3; ++axis) {
        polygon = clip(polygon, axis, static_cast<double>(box.lo[axis]), 1.0);
        polygon = clip(polygon, axis, static_cast<double>(box.hi[axis]), -1.0);
    }
    return polygon;
}

// The result is finite.
Box roundedOutwards(const glm::dvec3& lo, const glm::dvec3& hi)
{
    constexpr float kMax = std::numeric_limits<float>::max();
    Box box;
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = std::nextafter(static_cast<float>(std::max(lo[k], -static_cast<double>(kMax))), -kMax);
        box.hi[k] = std::nextafter(static_cast<float>(std::min(hi[k], static_cast<double>(kMax))), kMax);
    }
    return box;
}

// Within `clipped`, the box that the polygon was clipped by.
Box computePieceBox(const Polygon& polygon, const Box& clipped)
{
    glm::dvec3 lo = polygon.corners[0], hi = polygon.corners[0];
    for (const glm::dvec3& corner : std::span(polygon.corners).first(polygon.count)) {
        lo = glm::min(lo, corner);
        hi = glm::max(hi, corner);
    }
    const Box box = roundedOutwards(lo, hi);
    return {glm::max(box.lo, clipped.lo), glm::min(box.hi, clipped.hi)};
}

// Half of the box's surface area, minus the areas of the polygon's projections along the axes.
double computeWaste(const Polygon& polygon, const Box& box)
{
    glm::dvec3 twice(0.0);
    for (std::size_t i = 2; i < polygon.count; ++i) {
        twice += glm::cross(polygon.corners[i - 1] - polygon.corners[0], polygon.corners[i] - polygon.corners[0]);
    }
    return computeHalfArea(box) - 0.5 * (std::abs(twice.x) + std::abs(twice.y) + std::abs(twice.z));
}

struct Waste {
    double area;
    std::uint32_t piece;

    // The lower piece comes first if both waste the same.
    bool operator<(const Waste& other) const { return area != other.area ? area < other.area : piece > other.piece; }
};

struct Plane {
    int axis;
    float place;
};

class Splitter {
public:
    Splitter(std::span<const Triangle> triangles, std::vector<Box> boxes)
        : triangles_(triangles),
          whole_(boxes.front())
    {
        double sum = 0.0;
        for (const Box& box : boxes) {
            whole_.lo = glm::min(whole_.lo, box.lo);
            whole_.hi = glm::max(whole_.hi, box.hi);
            sum += computeHalfArea(box);
        }
        minWaste_ = kMinWaste * sum / static_cast<double>(boxes.size());
        pieces_.primitives.resize(boxes.size());
        std::iota(pieces_.primitives.begin(), pieces_.primitives.end(), 0U);
        pieces_.boxes = std::move(boxes);
    }

    Pieces split()
    {
        const std::size_t count = pieces_.boxes.size(), most = count + count / kMaxSplitShare;
        for (std::uint32_t id = 0; id < triangles_.size(); ++id) {
            consider(id);
        }
        while (!wastes_.empty() && pieces_.boxes.size() < most) {
            const std::uint32_t piece = wastes_.top().piece;
            wastes_.pop();
            split(piece);
        }
        if (pieces_.boxes.size() <= count + count / kMinSplitShare) {
            return {};
        }
        std::vector<bool> split(count, false);
        for (std::size_t piece = count; piece < pieces_.boxes.size(); ++piece) {
            split[pieces_.primitives[piece]] = true;
        }
        for (std::uint32_t piece = 0; piece < pieces_.boxes.size(); ++piece) {
            if (split[pieces_.primitives[piece]]) {
                grow(piece);
            }
        }
        return std::move(pieces_);
    }

private:
    void consider(std::uint32_t piece)
    {
        const Box& box = pieces_.boxes[piece];
        if (computeHalfArea(box) > minWaste_) {
            const double waste = computeWaste(clip(triangles_[pieces_.primitives[piece]], box), box);
            if (waste > minWaste_) {
                wastes_.push({waste, piece});
            }
        }
    }

    // The coarsest plane through the box's longest side: the one whose number ends in the most zero bits.
    std::optional<Plane> findPlane(const Box& box) const
    {
        const glm::dvec3 size = glm::dvec3(box.hi) - glm::dvec3(box.lo);
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const double origin = static_cast<double>(whole_.lo[axis]);
        const double step = (static_cast<double>(whole_.hi[axis]) - origin) / kPlanes;
        const auto lo = static_cast<std::uint32_t>((static_cast<double>(box.lo[axis]) - origin) / step);
        const auto hi = static_cast<std::uint32_t>(std::ceil((static_cast<double>(box.hi[axis]) - origin) / step)) - 1;  // below box.hi
        const int zeros = std::bit_width(lo ^ hi) - 1;
        const auto place = zeros < 0 ? box.lo[axis] : static_cast<float>(origin + static_cast<double>(hi >> zeros << zeros) * step);
        return place > box.lo[axis] && place < box.hi[axis] ? std::optional<Plane>({axis, place}) : std::nullopt;
    }

    void split(std::uint32_t piece)
    {
        const std::optional<Plane> plane = findPlane(pieces_.boxes[piece]);
        if (!plane) {
            return;
        }
        const std::uint32_t id = pieces_.primitives[piece];
        Box below = pieces_.boxes[piece], above = below;
        below.hi[plane->axis] = above.lo[plane->axis] = plane->place;
        const Polygon lower = clip(triangles_[id], below), upper = clip(triangles_[id], above);
        if (lower.count == 0 || upper.count == 0) {
            return;
        }
        pieces_.boxes[piece] = computePieceBox(lower, below);
        pieces_.boxes.push_back(computePieceBox(upper, above));
        pieces_.primitives.push_back(id);
        consider(piece);
        consider(static_cast<std::uint32_t>(pieces_.boxes.size() - 1));
    }

    void grow(std::uint32_t piece)
    {
        const auto& v = triangles_[pieces_.primitives[piece]].vertices;
        const glm::dvec3 size = glm::dvec3(glm::max(v[0], glm::max(v[1], v[2]))) - glm::dvec3(glm::min(v[0], glm::min(v[1], v[2])));
        const double margin = kCutMargin * std::max({size.x, size.y, size.z});
        Box& box = pieces_.boxes[piece];
        box = roundedOutwards(glm::dvec3(box.lo) - margin, glm::dvec3(box.hi) + margin);
    }

    std::span<const Triangle> triangles_;
    Box whole_;
    double minWaste_;
    Pieces pieces_;
    std::priority_queue<Waste> wastes_;
};

}  // namespace

Pieces splitTriangles(std::span<const Triangle> triangles, std::vector<Box> boxes) { return Splitter(triangles, std::move(boxes)).split(); }

}  // namespace glim
