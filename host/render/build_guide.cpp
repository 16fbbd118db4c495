// Cells are the leaves of k-d trees over the points, with about as many records each. A cell sees directions from its centre, as they point
// at a sphere around it: of several radii that one is taken which gathers most light in few places. So light that comes from a slit two
// metres away stays in one place of the square for all points of the cell. Then a quadtree over the square has leaves of about as much
// light each.
//
// Only additions, products, quotients and square roots: any host makes the same guide of the same records.
#include "host/render/build_guide.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/digest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

namespace glim {
namespace {

// Of 2048 to 65536 records, 8192 had the least variance (tests/bench/guiding.md), as had the next three numbers.
constexpr std::size_t kCellRecords = 8192;  // a cell has at most so many, and half of it or about that
constexpr double kQuadLight = 1.0 / 512.0;  // share of a cell's light from which on a quadrant is divided
constexpr std::size_t kQuadRecords = 24;    // quadrants with fewer are not divided
constexpr float kShare = 0.5F;              // of directions that are sampled by the guide
constexpr std::uint32_t kQuadLevels = 10;
constexpr std::size_t kLeastRecords = 64;  // a cell with fewer guides nobody
constexpr double kMostOfCell = 0.02;       // of a cell's light, for one record: the guide is not to follow one lucky path
constexpr double kUniform = 0.02;          // share of the guide's directions that are uniform over the square
// Of the mean. Where surfaces are brighter, as near a lamp, paths are not to end because all else is darker: the squared error was 4 times
// as large.
constexpr float kLeastRadiance = 0.03F, kMostRadiance = 3.0F;
constexpr int kFocusSide = 32;               // bins of the square, by which radii are compared
constexpr std::size_t kFocusRecords = 2048;  // that are enough for that
constexpr int kRadii = 12;

struct Point {
    vec3 p, w;
    float light;   // that the ray along w brought
    float direct;  // of the light sample
};

// As lib/octahedral.glsl.
glm::dvec3 decodeDirection(std::uint32_t bits)
{
    const auto low = static_cast<std::int16_t>(bits & 0xffffU), high = static_cast<std::int16_t>(bits >> 16U);
    const glm::dvec2 p(low / 32767.0, high / 32767.0);
    glm::dvec3 n(p, 1.0 - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0) {
        n.x = (1.0 - std::abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0);
        n.y = (1.0 - std::abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0);
    }
    return n / std::sqrt(glm::dot(n, n));
}

// As guideRootOf() in access/guide.glsl.
std::uint32_t rootOf(const glm::dvec3& n)
{
    const glm::dvec3 a = glm::abs(n);
    const std::uint32_t axis = a.x >= std::max(a.y, a.z) ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (n[static_cast<int>(axis)] < 0.0 ? 1 : 0);
}

// As lib/guide.glsl, in [0, 1).
glm::dvec2 squareFromDirection(const glm::dvec3& w)
{
    const glm::dvec2 p = glm::dvec2(w.x, w.y) / (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    glm::dvec2 q = p;
    if (w.z < 0.0) {
        q.x = (1.0 - std::abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0);
        q.y = (1.0 - std::abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0);
    }
    return glm::clamp(0.5 + 0.5 * q, 0.0, 0x1.fffffep-1);
}

glm::dvec2 squareOf(const Point& point, const glm::dvec3& center, double focus)
{
    const glm::dvec3 w(point.w);
    return squareFromDirection(focus > 0.0 ? glm::dvec3(point.p) - center + focus * w : w);
}

struct Cell {
    std::vector<std::uint32_t> points;
    glm::vec3 center{0.0F};
    float focus = 0.0F;
    double radiance = 0.0, reflected = 0.0;
    std::vector<GuideQuad> quads;  // links relative to the first
};

// The sum over the bins of the square of their light, without what each record adds by itself.
double concentrationOf(const std::vector<Point>& points, const Cell& cell, double focus)
{
    std::vector<double> bins(kFocusSide * kFocusSide, 0.0);
    double own = 0.0;
    const std::size_t step = std::max<std::size_t>(1, cell.points.size() / kFocusRecords);
    for (std::size_t i = 0; i < cell.points.size(); i += step) {
        const Point& point = points[cell.points[i]];
        if (point.light > 0.0F) {
            const glm::dvec2 square = squareOf(point, cell.center, focus);
            const double light = static_cast<double>(point.light);
            bins[static_cast<int>(square.y * kFocusSide) * kFocusSide + static_cast<int>(square.x * kFocusSide)] += light;
            own += light * light;
        }
    }
    return std::accumulate(bins.begin(), bins.end(), -own, [](double sum, double bin) { return sum + bin * bin; });
}

void chooseFocus(const std::vector<Point>& points, Cell& cell)
{
    glm::dvec3 mean(0.0);
    for (const std::uint32_t i : cell.points) {
        mean += glm::dvec3(points[i].p);
    }
    cell.center = glm::vec3(mean / static_cast<double>(cell.points.size()));
    double radius2 = 0.0;
    for (const std::uint32_t i : cell.points) {
        const glm::dvec3 v = glm::dvec3(points[i].p) - glm::dvec3(cell.center);
        radius2 = std::max(radius2, glm::dot(v, v));
    }
    double best = concentrationOf(points, cell, 0.0);
    double focus = 1.25 * std::sqrt(radius2);
    for (int i = 0; i < kRadii && radius2 > 0.0; ++i, focus *= 1.4142135623730951) {
        const double found = concentrationOf(points, cell, static_cast<double>(static_cast<float>(focus)));
        if (found > best) {
            best = found;
            cell.focus = static_cast<float>(focus);
        }
    }
}

struct Item {
    glm::dvec2 square;
    double light;
};

class QuadBuilder {
public:
    QuadBuilder(std::vector<GuideQuad>& quads, double total)
        : quads_(quads),
          total_(total)
    {}

    // The node of these items, in the square of `size` at `corner`.
    std::uint32_t addNode(const std::vector<Item>& items, glm::dvec2 corner, double size, std::uint32_t level)
    {
        const auto index = static_cast<std::uint32_t>(quads_.size());
        quads_.emplace_back();
        const double half = size / 2;
        std::array<std::vector<Item>, 4> parts;
        for (const Item& item : items) {
            parts[(item.square.x >= corner.x + half ? 1 : 0) + (item.square.y >= corner.y + half ? 2 : 0)].push_back(item);
        }
        GuideQuad quad{};
        std::array<double, 4> mass{};
        for (std::uint32_t q = 0; q < 4; ++q) {
            const double light =
                std::accumulate(parts[q].begin(), parts[q].end(), 0.0, [](double sum, const Item& item) { return sum + item.light; });
            const double share = (1.0 - kUniform) * light / total_ + kUniform * half * half;
            mass[q] = share;
            if (level + 1 < kQuadLevels && light > kQuadLight * total_ && parts[q].size() >= kQuadRecords) {
                const glm::dvec2 at = corner + half * glm::dvec2(q & 1U, q >> 1U);
                quad.quadrants[static_cast<int>(q)] = addNode(parts[q], at, half, level + 1) | kGuideQuadNode;
            } else {
                quad.quadrants[static_cast<int>(q)] = std::bit_cast<std::uint32_t>(static_cast<float>(share / (half * half)));
            }
        }
        const double left = mass[0] + mass[2], right = mass[1] + mass[3];
        quad.lowX = static_cast<float>(left / (left + right));
        quad.lowY = glm::vec2(static_cast<float>(mass[0] / left), static_cast<float>(mass[1] / right));
        quads_[index] = quad;
        return index;
    }

private:
    std::vector<GuideQuad>& quads_;
    double total_;
};

void describeLight(const std::vector<Point>& points, Cell& cell)
{
    double total = 0.0, direct = 0.0;
    for (const std::uint32_t i : cell.points) {
        total += static_cast<double>(points[i].light);
        direct += static_cast<double>(points[i].direct);
    }
    const auto count = static_cast<double>(cell.points.size());
    cell.reflected = total / count;
    cell.radiance = (total + direct) / count;
    if (cell.points.size() < kLeastRecords || !(total > 0.0)) {
        return;
    }
    std::vector<Item> items;
    double kept = 0.0;
    for (const std::uint32_t i : cell.points) {
        if (points[i].light > 0.0F) {
            items.push_back({squareOf(points[i], cell.center, static_cast<double>(cell.focus)),
                             std::min(static_cast<double>(points[i].light), kMostOfCell * total)});
            kept += items.back().light;
        }
    }
    QuadBuilder(cell.quads, kept).addNode(items, glm::dvec2(0.0), 1.0, 0);
}

class TreeBuilder {
public:
    TreeBuilder(const std::vector<Point>& points, std::vector<GuideNode>& nodes, std::vector<Cell>& cells)
        : points_(points),
          nodes_(nodes),
          cells_(cells)
    {}

    // Sets node `index` of these points. A leaf has the number of its cell plus 1, for now.
    void build(std::uint32_t index, std::vector<std::uint32_t> of)
    {
        vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const std::uint32_t i : of) {
            low = glm::min(low, points_[i].p);
            high = glm::max(high, points_[i].p);
        }
        const vec3 size = high - low;
        const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
        const float split = of.size() > kCellRecords ? splitOf(of, axis) : 0.0F;
        std::vector<std::uint32_t> below, above;
        if (of.size() > kCellRecords) {
            for (const std::uint32_t i : of) {
                (points_[i].p[axis] < split ? below : above).push_back(i);
            }
        }
        if (below.empty() || above.empty()) {
            nodes_[index] = {0.0F, kGuideLeaf, of.empty() ? 0 : static_cast<std::uint32_t>(cells_.size() + 1), 0};
            if (!of.empty()) {
                cells_.emplace_back().points = std::move(of);
            }
            return;
        }
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        nodes_[index] = {split, static_cast<std::uint32_t>(axis), child, 0};
        of = {};
        build(child, std::move(below));
        build(child + 1, std::move(above));
    }

private:
    // The median or, if no point is below it, as on a wall across the axis, the next place where points are.
    float splitOf(const std::vector<std::uint32_t>& of, int axis) const
    {
        std::vector<float> places;
        for (const std::uint32_t i : of) {
            places.push_back(points_[i].p[axis]);
        }
        const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
        std::nth_element(places.begin(), middle, places.end());
        const float median = *middle;
        if (*std::min_element(places.begin(), places.end()) < median) {
            return median;
        }
        float next = std::numeric_limits<float>::infinity();
        for (const float place : places) {
            next = place > median ? std::min(next, place) : next;
        }
        return next;
    }

    const std::vector<Point>& points_;
    std::vector<GuideNode>& nodes_;
    std::vector<Cell>& cells_;
};

template <class T>
void append(std::vector<uvec4>& texels, const T& value)
{
    static_assert(sizeof(T) % sizeof(uvec4) == 0);
    const auto words = std::bit_cast<std::array<uvec4, sizeof(T) / sizeof(uvec4)>>(value);
    texels.insert(texels.end(), words.begin(), words.end());
}

Guide pack(std::vector<GuideNode> nodes, const std::vector<Cell>& cells, double mean)
{
    auto at = static_cast<std::uint32_t>(nodes.size());
    std::vector<std::uint32_t> places;
    for (const Cell& cell : cells) {
        places.push_back(at);
        at += kGuideCellTexels + static_cast<std::uint32_t>(cell.quads.size()) * kGuideQuadTexels;
    }
    Guide guide;
    guide.texels.reserve(at);
    for (GuideNode& node : nodes) {
        node.child = node.axis == kGuideLeaf && node.child > 0 ? places[node.child - 1] : node.child;
        append(guide.texels, node);
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Cell& cell = cells[i];
        const std::uint32_t first = places[i] + kGuideCellTexels;
        const auto radiance = static_cast<float>(mean > 0.0 ? cell.radiance / mean : 1.0);
        append(guide.texels, GuideCell{cell.center, cell.focus, first, cell.quads.empty() ? 0.0F : kShare,
                                       std::clamp(radiance, kLeastRadiance, kMostRadiance), static_cast<float>(cell.reflected)});
        for (GuideQuad quad : cell.quads) {
            for (int q = 0; q < 4; ++q) {
                if ((quad.quadrants[q] & kGuideQuadNode) != 0) {
                    quad.quadrants[q] = kGuideQuadNode | (first + (quad.quadrants[q] & ~kGuideQuadNode) * kGuideQuadTexels);
                }
            }
            append(guide.texels, quad);
        }
    }
    guide.cells = static_cast<std::uint32_t>(cells.size());
    Digest digest;
    digest.add(guide.texels);
    guide.digest = digest.finish().substr(0, 16);
    return guide;
}

}  // namespace

Guide emptyGuide() { return pack(std::vector<GuideNode>(kGuideRoots, GuideNode{0.0F, kGuideLeaf, 0, 0}), {}, 0.0); }

Guide buildGuide(std::span<const GuideRecord> records)
{
    std::vector<Point> points;
    std::array<std::vector<std::uint32_t>, kGuideRoots> roots;
    for (const GuideRecord& record : records) {
        const float sum = record.value + record.direct + record.point.x + record.point.y + record.point.z;
        if (record.throughput > 0.0F && std::isfinite(sum) && std::isfinite(record.throughput)) {
            roots[rootOf(decodeDirection(record.normal))].push_back(static_cast<std::uint32_t>(points.size()));
            points.push_back({record.point, vec3(decodeDirection(record.direction)), record.value / record.throughput,
                              record.direct / record.throughput});
        }
    }
    std::vector<GuideNode> nodes(kGuideRoots);
    std::vector<Cell> cells;
    TreeBuilder builder(points, nodes, cells);
    for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
        builder.build(root, std::move(roots[root]));
    }
    parallelFor(cells.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
        chooseFocus(points, cells[i]);
        describeLight(points, cells[i]);
    });
    double sum = 0.0;
    for (const Cell& cell : cells) {
        sum += cell.radiance * static_cast<double>(cell.points.size());
    }
    return pack(std::move(nodes), cells, points.empty() ? 0.0 : sum / static_cast<double>(points.size()));
}

}  // namespace glim
