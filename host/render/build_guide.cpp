// Cells are the leaves of k-d trees over the points, with about as many records each. A cell sees directions from its centre, as they point
// at a sphere around it: of several radii that one is taken which gathers most light in few places. So light that comes from a slit two
// metres away stays in one place of the square for all points of the cell. Then a quadtree over the square has leaves of about as much
// light each.
//
// Only additions, products, quotients and square roots: any host makes the same guide of the same records.
#include "host/render/build_guide.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/digest.hpp"
#include "shaders/shared/path_types.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>
#include <utility>

namespace glim {
namespace {

// The numbers that had the least variance (tests/bench/guiding.md).
constexpr double kCellRecords = 4.0;  // times the root of how many there are: a cell has at most so many, and half of it or about that
constexpr double kLeastCellRecords = 2048.0;
constexpr double kQuadLight = 1.0 / 512.0;  // share of a cell's light from which on a quadrant is divided
constexpr std::size_t kQuadRecords = 24;    // quadrants with fewer are not divided
constexpr std::uint32_t kQuadLevels = 10;
constexpr double kDoubt = 3.0;  // typical records that a node is taken to have besides, spread over its quadrants
// Second moments are equal where light samples are worth as much as the next rays. Paths cost about four times as much as shadow rays.
constexpr double kShadowRays = 4.0;
constexpr double kMostOfCell = 0.02;  // of a cell's light, for one record: the guide is not to follow one lucky path
constexpr double kUniform = 0.02;     // share of the guide's directions that are uniform over the square
// Of the mean. Where surfaces are brighter, as near a lamp, paths are not to end because all else is darker: the squared error was 4 times
// as large.
constexpr float kLeastRadiance = 0.03F, kMostRadiance = 3.0F;
constexpr std::size_t kLeastRecords = 64;    // a cell with fewer guides nobody
constexpr std::size_t kFocusRecords = 2048;  // that are enough to compare radii,
constexpr int kFocusSide = 32;               // by so many bins of the square on a side
constexpr int kRadii = 12;
constexpr float kWall = 1e-3F;                // of the box: points as near to each other may be on a wall, and are
constexpr std::size_t kWallShare = 32;        // if they are this part of all
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
    std::uint32_t texel;
    Points points;
    glm::vec3 center{0.0F};
    float focus = 0.0F;
    double radiance = 0.0, reflected = 0.0;
    std::uint32_t sight = 0;
    std::vector<GuideQuad> quads;
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
    if (cell.points.empty()) {
        return;
    }
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

float luminanceOf(std::uint32_t direct) { return std::bit_cast<float>(direct & ~(kSampledLights | kSampleBlocked)); }

struct Item {
    glm::dvec2 square;
    double light;
};

// The one by which samples of two parts vary least, if the first one's light is `probability` of all.
std::uint32_t wordOf(double probability)
{
    const auto cost = [&](std::uint32_t word) {
        const auto p = static_cast<double>(guideProbability(word));
        return (p - probability) * (p - probability) / (p * (1.0 - p));
    };
    std::uint32_t word = 1;
    while (word < 63 && cost(word + 1) < cost(word)) {
        ++word;
    }
    return word;
}

class QuadBuilder {
public:
    QuadBuilder(std::vector<GuideQuad>& quads, double total)
        : quads_(quads),
          total_(total)
    {}

    struct Square {
        std::vector<Item> items;         // with their places in it
        double light = 0.0, area = 0.0;  // that they bring, smoothed; of all directions' square
        bool divides = false;
    };

    // Sets node `index`.
    void build(std::uint32_t index, const Square& square, std::uint32_t level)
    {
        GuideQuad quad{};
        std::vector<std::pair<std::uint32_t, Square>> divided;
        const std::array<Square, 4> quadrants = divide(square, 0, quad);
        for (std::uint32_t q = 0; q < 4; ++q) {
            std::array<Square, 4> inner = divide(quadrants[q], 1 + q, quad);
            for (std::uint32_t r = 0; r < 4; ++r) {
                if (inner[r].divides && level + 2 < kQuadLevels) {
                    divided.emplace_back(4 * q + r, std::move(inner[r]));
                    quad.children |= 1U << (4 * q + r);
                }
            }
        }
        auto child = static_cast<std::uint32_t>(quads_.size());
        quad.children |= child << 16U;
        quads_[index] = quad;
        quads_.resize(quads_.size() + divided.size());
        for (const auto& [number, part] : divided) {
            build(child++, part, level + 2);
        }
    }

private:
    // The quadrants of `square`, whose probabilities are the words `number`.
    std::array<Square, 4> divide(const Square& square, std::uint32_t number, GuideQuad& quad) const
    {
        std::array<Square, 4> parts;
        std::array<double, 4> found{};
        double sum = 0.0, squares = 0.0;
        for (const Item& item : square.items) {
            const int x = item.square.x >= 0.5 ? 1 : 0, y = item.square.y >= 0.5 ? 1 : 0;
            parts[x + 2 * y].items.push_back({2.0 * item.square - glm::dvec2(x, y), item.light});
            found[x + 2 * y] += item.light;
            sum += item.light;
            squares += item.light * item.light;
        }
        const double doubt = square.divides ? kDoubt * squares / sum : 0.0;
        std::array<double, 4> mass{};
        for (std::uint32_t q = 0; q < 4; ++q) {
            Square& part = parts[q];
            part.area = 0.25 * square.area;
            part.light = square.divides ? square.light * (found[q] + 0.25 * doubt) / (sum + doubt) : 0.25 * square.light;
            part.divides = square.divides && found[q] > kQuadLight * total_ && part.items.size() >= kQuadRecords;
            mass[q] = (1.0 - kUniform) * part.light / total_ + kUniform * part.area;
        }
        const double left = mass[0] + mass[2], right = mass[1] + mass[3];
        quad.lowX |= wordOf(left / (left + right)) << (6 * number);
        quad.lowYOfLowX |= wordOf(mass[0] / left) << (6 * number);
        quad.lowYOfHighX |= wordOf(mass[1] / right) << (6 * number);
        return parts;
    }

    std::vector<GuideQuad>& quads_;
    double total_;
};

// Light samples of some lights.
struct SampledLights {
    double attempted = 0.0, squares = 0.0, arrived = 0.0;

    void add(const SampledLights& other)
    {
        attempted += other.attempted;
        squares += other.squares;
        arrived += other.arrived;
    }

    // Half octaves. Lights that are seen from a share of the points are best chosen by its root.
    std::uint32_t steps() const
    {
        const double doubt = attempted > 0.0 ? kDoubt * squares / attempted : 1.0, visible = (arrived + doubt) / (attempted + doubt);
        std::uint32_t steps = 0;
        while (steps < kSightSteps && std::ldexp(visible, static_cast<int>(steps) + 1) <= 1.0) {
            ++steps;
        }
        return steps;
    }
};

// `direct`, `found`: squares of light that light samples have brought, and the next rays.
std::uint32_t sightOf(std::array<SampledLights, kSightGroups> lights, double direct, double found)
{
    for (std::uint32_t part = 0; part < kSightOfInfinite; ++part) {
        lights[kSightOfFinite].add(lights[part]);
    }
    std::uint32_t sight = 0, rarer = 0;
    for (std::uint32_t group = 0; group < kSightGroups; ++group) {
        sight |= lights[group].steps() << (3 * group);
    }
    while (rarer < kSampleSteps && std::ldexp(kShadowRays * direct, 2 * static_cast<int>(rarer) + 2) <= found) {
        ++rarer;
    }
    return sight | rarer << 30U;
}

void describeLight(Cell& cell)
{
    double total = 0.0, direct = 0.0, totalSquares = 0.0, directSquares = 0.0;
    std::array<SampledLights, kSightGroups> lights;
    for (const GuidePoint& point : cell.points) {
        const auto light = static_cast<double>(point.light), sampled = static_cast<double>(luminanceOf(point.direct));
        const double arrived = (point.direct & kSampleBlocked) == 0 ? sampled : 0.0;
        total += light;
        totalSquares += light * light;
        direct += arrived;
        directSquares += arrived * arrived;
        lights[std::min(point.direct & kSampledLights, kSightOfInfinite)].add({sampled, sampled * sampled, arrived});
    }
    const auto count = std::max(1.0, static_cast<double>(cell.points.size()));
    cell.reflected = total / count;
    cell.radiance = (total + direct) / count;
    if (cell.points.size() < kLeastRecords || !(total > 0.0)) {
        return;
    }
    cell.sight = sightOf(lights, directSquares, totalSquares);
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
    QuadBuilder(cell.quads, kept).build(0, {std::move(items), kept, 1.0, true}, 0);
}

template <class T>
void put(std::vector<uvec4>& texels, std::size_t at, const T& value)
{
    static_assert(sizeof(T) % sizeof(uvec4) == 0);
    const auto words = std::bit_cast<std::array<uvec4, sizeof(T) / sizeof(uvec4)>>(value);
    std::ranges::copy(words, texels.begin() + static_cast<std::ptrdiff_t>(at));
}

// More records make both more cells and better known ones.
class TreeBuilder {
public:
    TreeBuilder(std::size_t cellRecords, std::vector<uvec4>& texels, std::vector<Cell>& cells)
        : cellRecords_(cellRecords),
          texels_(texels),
          cells_(cells)
    {}

    // Sets the node at `texel` of these points, and puts them in its order.
    void build(std::uint32_t texel, Points points) { build(texel, points, splitOf(points)); }

private:
    struct Split {
        std::uint32_t axis = kGuideNoSplit;
        float at = 0.0F;
    };

    void build(std::uint32_t texel, Points points, Split split)
    {
        const std::size_t block = texels_.size() / kGuideBlockTexels;
        texels_.resize(texels_.size() + kGuideBlockTexels);
        GuideNode node{split.at, vec2(0.0F), split.axis | static_cast<std::uint32_t>(block) << 10U};
        const std::array<Points, 2> halves = divide(points, split);
        std::array<Points, 4> quarters;
        for (int half = 0; half < 2; ++half) {
            const Split second = splitOf(halves[half]);
            node.halfSplits[half] = second.at;
            node.children |= second.axis << (2 + 2 * half);
            std::ranges::copy(divide(halves[half], second), quarters.begin() + std::ptrdiff_t{2} * half);
        }
        for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
            const auto at = static_cast<std::uint32_t>(block * kGuideBlockTexels + 2 * quarter);
            const Split next = splitOf(quarters[quarter]);
            if (next.axis != kGuideNoSplit) {
                build(at, quarters[quarter], next);
            } else {
                node.children |= 1U << (6 + quarter);
                cells_.push_back({at, quarters[quarter]});
            }
        }
        put(texels_, texel, node);
    }

    static std::array<Points, 2> divide(Points points, Split split)
    {
        // Stable, as sums are to be of one order in all standard libraries.
        const auto above =
            split.axis == kGuideNoSplit ? points.end() : std::stable_partition(points.begin(), points.end(), [&](const GuidePoint& point) {
                return point.p[static_cast<int>(split.axis)] < split.at;
            });
        return {Points(points.begin(), above), Points(above, points.end())};
    }

    // Of points that are to be more cells than one.
    Split splitOf(Points points) const
    {
        if (points.size() <= cellRecords_) {
            return {};
        }
        vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const GuidePoint& point : points) {
            low = glm::min(low, point.p);
            high = glm::max(high, point.p);
        }
        const vec3 size = high - low;
        const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
        return size[axis] > 0.0F ? Split{static_cast<std::uint32_t>(axis), placeOf(points, axis, low[axis], high[axis])} : Split{};
    }

    // The median; if that is in a wall across the axis, the middle of a gap beside it: within the wall, points would be parted by rounding.
    static float placeOf(Points points, int axis, float low, float high)
    {
        std::vector<float> places;
        for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kMedianRecords)) {
            places.push_back(points[i].p[axis]);
        }
        std::ranges::sort(places);
        const float median = places[places.size() / 2], margin = kWall * (high - low);
        const auto begin = std::ranges::lower_bound(places, median - margin), end = std::ranges::upper_bound(places, median + margin);
        const auto before = begin - places.begin(), after = places.end() - end;
        if (static_cast<std::size_t>(end - begin) < places.size() / kWallShare) {
            return median;
        }
        float split = low + 0.5F * (high - low);
        if (before + after > 0) {
            const float beside = before > after ? *(begin - 1) : *end;
            split = std::max(median, beside) - 0.5F * std::abs(median - beside);
        }
        return split > low ? split : high;  // of neighbouring numbers the mean may be the lower one
    }

    std::size_t cellRecords_;
    std::vector<uvec4>& texels_;
    std::vector<Cell>& cells_;
};

// Of the trees over points, the cells, and after them their quadtrees.
Guide pack(std::vector<uvec4> texels, const std::vector<Cell>& cells, double mean)
{
    Guide guide;
    for (const Cell& cell : cells) {
        const bool guides = !cell.quads.empty();
        const auto radiance = static_cast<float>(mean > 0.0 && !cell.points.empty() ? cell.radiance / mean : 1.0);
        put(texels, cell.texel,
            GuideCell{cell.center, cell.focus, guides ? static_cast<std::uint32_t>(texels.size()) : kUniformQuadtree, cell.sight,
                      std::clamp(radiance, kLeastRadiance, kMostRadiance), static_cast<float>(cell.reflected)});
        for (const GuideQuad& quad : cell.quads) {
            texels.push_back(std::bit_cast<uvec4>(quad));
        }
        guide.cells += cell.points.empty() ? 0 : 1;
    }
    guide.texels = std::move(texels);
    guide.digest = digestOf(guide.texels);
    return guide;
}

// A tree's root, and its points.
using Root = std::pair<std::uint32_t, Points>;

Guide buildGuide(std::span<const Root> roots)
{
    const std::size_t count = std::accumulate(roots.begin(), roots.end(), std::size_t{0},
                                              [](std::size_t sum, const Root& root) { return sum + root.second.size(); });
    const auto cellRecords = static_cast<std::size_t>(std::max(kLeastCellRecords, kCellRecords * std::sqrt(static_cast<double>(count))));
    std::vector<uvec4> texels(kGuideBlockTexels);
    put(texels, kUniformQuadtree, GuideQuad{kGuideHalves, kGuideHalves, kGuideHalves, 0});
    std::vector<Cell> cells;
    TreeBuilder builder(cellRecords, texels, cells);
    for (const auto& [texel, points] : roots) {
        builder.build(texel, points);
    }
    parallelFor(cells.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
        chooseFocus(cells[i]);
        describeLight(cells[i]);
    });
    double sum = 0.0;
    for (const Cell& cell : cells) {
        sum += cell.radiance * static_cast<double>(cell.points.size());
    }
    return pack(std::move(texels), cells, count == 0 ? 0.0 : sum / static_cast<double>(count));
}

}  // namespace

Guide emptyGuide(bool scatterings) { return GuideBuilder(scatterings).build(); }

std::string digestOf(const std::vector<uvec4>& texels)
{
    Digest digest;
    digest.add(texels);
    return digest.finish().substr(0, 16);
}

void GuideBuilder::add(std::span<const GuideRecord> records)
{
    for (const GuideRecord& record : records) {
        const float sampled = luminanceOf(record.direct);
        const float sum = record.value + sampled + record.point.x + record.point.y + record.point.z;
        if (record.throughput > 0.0F && std::isfinite(sum) && std::isfinite(record.throughput)) {
            (record.normal == kNoReceiverNormal ? scattered_ : points_[rootOf(decodeDirection(record.normal))])
                .push_back({record.point, record.direction, record.value / record.throughput,
                            (std::bit_cast<std::uint32_t>(sampled / record.throughput) & ~kSampledLights) |
                                (record.direct & (kSampledLights | kSampleBlocked))});
        }
    }
}

Guide GuideBuilder::build()
{
    std::vector<Root> roots;
    for (std::uint32_t root = 0; root < kGuideRoots; ++root) {
        roots.emplace_back(root, points_[root]);
    }
    if (scatterings_) {
        roots.emplace_back(kGuideOfScatterings, scattered_);
    }
    return buildGuide(roots);
}

}  // namespace glim
