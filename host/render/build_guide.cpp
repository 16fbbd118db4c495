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

// The numbers that had the least variance (tests/bench/guiding.md).
constexpr double kCellRecords = 4.0;  // times the root of how many there are: a cell has at most so many, and half of it or about that
constexpr double kLeastCellRecords = 2048.0;
constexpr double kQuadLight = 1.0 / 512.0;  // share of a cell's light from which on a quadrant is divided
constexpr std::size_t kQuadRecords = 24;    // quadrants with fewer are not divided
constexpr std::uint32_t kQuadLevels = 10;
constexpr double kDoubt = 3.0;        // typical records that a node is taken to have besides, spread over its quadrants
constexpr float kShare = 0.7F;        // of directions that are sampled by the guide
constexpr double kMostOfCell = 0.02;  // of a cell's light, for one record: the guide is not to follow one lucky path
constexpr double kUniform = 0.02;     // share of the guide's directions that are uniform over the square
// Of the mean. Where surfaces are brighter, as near a lamp, paths are not to end because all else is darker: the squared error was 4 times
// as large.
constexpr float kLeastRadiance = 0.03F, kMostRadiance = 3.0F;
constexpr std::size_t kLeastRecords = 64;    // a cell with fewer guides nobody
constexpr std::size_t kFocusRecords = 2048;  // that are enough to compare radii,
constexpr int kFocusSide = 32;               // by so many bins of the square on a side
constexpr int kRadii = 12;
constexpr float kWall = 1e-3F;                // of the box: points as near to its side are on it
constexpr std::size_t kMedianRecords = 4096;  // that are enough for a median

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

glm::dvec2 squareOf(const GuidePoint& point, const glm::dvec3& center, double focus)
{
    const glm::dvec3 w = decodeDirection(point.direction);
    return squareFromDirection(focus > 0.0 ? glm::dvec3(point.p) - center + focus * w : w);
}

using Points = std::span<GuidePoint>;

struct Cell {
    Points points;
    glm::vec3 center{0.0F};
    float focus = 0.0F;
    double radiance = 0.0, reflected = 0.0;
    std::vector<GuideQuad> quads;  // links relative to the first
};

// The sum over the bins of the square of their light, without what each record adds by itself.
double concentrationOf(const Cell& cell, double focus)
{
    std::vector<double> bins(kFocusSide * kFocusSide, 0.0);
    double own = 0.0;
    const std::size_t step = std::max<std::size_t>(1, cell.points.size() / kFocusRecords);
    for (std::size_t i = 0; i < cell.points.size(); i += step) {
        const GuidePoint& point = cell.points[i];
        if (point.light > 0.0F) {
            const glm::dvec2 square = squareOf(point, cell.center, focus);
            const double light = static_cast<double>(point.light);
            bins[static_cast<int>(square.y * kFocusSide) * kFocusSide + static_cast<int>(square.x * kFocusSide)] += light;
            own += light * light;
        }
    }
    return std::accumulate(bins.begin(), bins.end(), -own, [](double sum, double bin) { return sum + bin * bin; });
}

void chooseFocus(Cell& cell)
{
    glm::dvec3 mean(0.0);
    for (const GuidePoint& point : cell.points) {
        mean += glm::dvec3(point.p);
    }
    cell.center = glm::vec3(mean / static_cast<double>(cell.points.size()));
    double radius2 = 0.0;
    for (const GuidePoint& point : cell.points) {
        const glm::dvec3 v = glm::dvec3(point.p) - glm::dvec3(cell.center);
        radius2 = std::max(radius2, glm::dot(v, v));
    }
    double best = concentrationOf(cell, 0.0);
    double focus = 1.25 * std::sqrt(radius2);
    for (int i = 0; i < kRadii && radius2 > 0.0; ++i, focus *= 1.4142135623730951) {
        const double found = concentrationOf(cell, static_cast<double>(static_cast<float>(focus)));
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

    // Sets node `index`, whose items have their places in its square. `light`: what they bring, smoothed. `area`: of its square.
    void build(std::uint32_t index, const std::vector<Item>& items, double light, double area, std::uint32_t level)
    {
        std::array<std::vector<Item>, 4> parts;
        std::array<double, 4> found{};
        double sum = 0.0, squares = 0.0;
        for (const Item& item : items) {
            const int x = item.square.x >= 0.5 ? 1 : 0, y = item.square.y >= 0.5 ? 1 : 0;
            parts[x + 2 * y].push_back({2.0 * item.square - glm::dvec2(x, y), item.light});
            found[x + 2 * y] += item.light;
            sum += item.light;
            squares += item.light * item.light;
        }
        const double doubt = kDoubt * squares / sum;
        std::array<double, 4> mass{};
        std::uint32_t divided = 0;
        for (std::uint32_t q = 0; q < 4; ++q) {
            const double smoothed = light * (found[q] + 0.25 * doubt) / (sum + doubt);
            mass[q] = (1.0 - kUniform) * smoothed / total_ + kUniform * 0.25 * area;
            if (level + 1 < kQuadLevels && found[q] > kQuadLight * total_ && parts[q].size() >= kQuadRecords) {
                divided |= 1U << q;
            }
        }
        const double left = mass[0] + mass[2], right = mass[1] + mass[3];
        auto child = static_cast<std::uint32_t>(quads_.size());
        quads_[index] = {static_cast<float>(left / (left + right)),
                         glm::vec2(static_cast<float>(mass[0] / left), static_cast<float>(mass[1] / right)), child << 4U | divided};
        quads_.resize(quads_.size() + static_cast<std::size_t>(std::popcount(divided)));
        for (std::uint32_t q = 0; q < 4; ++q) {
            if ((divided >> q & 1U) != 0) {
                build(child++, parts[q], light * (found[q] + 0.25 * doubt) / (sum + doubt), 0.25 * area, level + 1);
            }
        }
    }

private:
    std::vector<GuideQuad>& quads_;
    double total_;
};

void describeLight(Cell& cell)
{
    double total = 0.0, direct = 0.0;
    for (const GuidePoint& point : cell.points) {
        total += static_cast<double>(point.light);
        direct += static_cast<double>(point.direct);
    }
    const auto count = static_cast<double>(cell.points.size());
    cell.reflected = total / count;
    cell.radiance = (total + direct) / count;
    if (cell.points.size() < kLeastRecords || !(total > 0.0)) {
        return;
    }
    std::vector<Item> items;
    double kept = 0.0;
    for (const GuidePoint& point : cell.points) {
        if (point.light > 0.0F) {
            items.push_back({squareOf(point, cell.center, static_cast<double>(cell.focus)),
                             std::min(static_cast<double>(point.light), kMostOfCell * total)});
            kept += items.back().light;
        }
    }
    cell.quads.resize(1);
    QuadBuilder(cell.quads, kept).build(0, items, kept, 1.0, 0);
}

// More records make both more cells and better known ones.
class TreeBuilder {
public:
    TreeBuilder(std::size_t cellRecords, std::vector<GuideNode>& nodes, std::vector<Cell>& cells)
        : cellRecords_(cellRecords),
          nodes_(nodes),
          cells_(cells)
    {}

    // Sets node `index` of these points, and puts them in its order. A leaf has the number of its cell plus 1, for now.
    void build(std::uint32_t index, Points points)
    {
        vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const GuidePoint& point : points) {
            low = glm::min(low, point.p);
            high = glm::max(high, point.p);
        }
        const vec3 size = high - low;
        const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
        const bool divides = points.size() > cellRecords_ && size[axis] > 0.0F;
        if (!divides) {
            nodes_[index] = {0.0F, kGuideLeaf, points.empty() ? 0 : static_cast<std::uint32_t>(cells_.size() + 1), 0};
            if (!points.empty()) {
                cells_.emplace_back().points = points;
            }
            return;
        }
        const float split = splitOf(points, axis, low[axis], high[axis]);
        // Stable, as sums are to be of one order in all standard libraries.
        const auto above =
            std::stable_partition(points.begin(), points.end(), [&](const GuidePoint& point) { return point.p[axis] < split; });
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        nodes_[index] = {split, static_cast<std::uint32_t>(axis), child, 0};
        build(child, Points(points.begin(), above));
        build(child + 1, Points(above, points.end()));
    }

private:
    // About the median; the middle of the box if that is at one of its sides, as if most points are on a wall across the axis: a split
    // within the wall would be by rounding.
    static float splitOf(Points points, int axis, float low, float high)
    {
        std::vector<float> places;
        for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kMedianRecords)) {
            places.push_back(points[i].p[axis]);
        }
        const auto median = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
        std::nth_element(places.begin(), median, places.end());
        const float margin = kWall * (high - low), middle = low + 0.5F * (high - low);
        const float split = *median > low + margin && *median < high - margin ? *median : middle;
        return split > low ? split : high;
    }

    std::size_t cellRecords_;
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
        at += kGuideCellTexels + static_cast<std::uint32_t>(cell.quads.size());
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
        const bool knows = !cell.quads.empty();
        append(guide.texels, GuideCell{cell.center, cell.focus, knows ? first : kUniformQuadtree, knows ? kShare : 0.0F,
                                       std::clamp(radiance, kLeastRadiance, kMostRadiance), static_cast<float>(cell.reflected)});
        for (GuideQuad quad : cell.quads) {
            quad.children += first << 4U;
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

// The roots, and a quadtree of uniform directions.
std::vector<GuideNode> firstNodes()
{
    std::vector<GuideNode> nodes(kGuideRoots, GuideNode{0.0F, kGuideLeaf, 0, 0});
    nodes.push_back(std::bit_cast<GuideNode>(GuideQuad{0.5F, glm::vec2(0.5F), 0}));
    return nodes;
}

Guide emptyGuide() { return pack(firstNodes(), {}, 0.0); }

void GuideBuilder::add(std::span<const GuideRecord> records)
{
    for (const GuideRecord& record : records) {
        const float sum = record.value + record.direct + record.point.x + record.point.y + record.point.z;
        if (record.throughput > 0.0F && std::isfinite(sum) && std::isfinite(record.throughput)) {
            points_[rootOf(decodeDirection(record.normal))].push_back(
                {record.point, record.direction, record.value / record.throughput, record.direct / record.throughput});
        }
    }
}

Guide GuideBuilder::build()
{
    std::size_t count = 0;
    for (const std::vector<GuidePoint>& points : points_) {
        count += points.size();
    }
    const auto cellRecords = static_cast<std::size_t>(std::max(kLeastCellRecords, kCellRecords * std::sqrt(static_cast<double>(count))));
    std::vector<GuideNode> nodes = firstNodes();
    std::vector<Cell> cells;
    TreeBuilder builder(cellRecords, nodes, cells);
    for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
        builder.build(root, points_[root]);
    }
    parallelFor(cells.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
        chooseFocus(cells[i]);
        describeLight(cells[i]);
    });
    double sum = 0.0;
    for (const Cell& cell : cells) {
        sum += cell.radiance * static_cast<double>(cell.points.size());
    }
    return pack(std::move(nodes), cells, count == 0 ? 0.0 : sum / static_cast<double>(count));
}

}  // namespace glim
