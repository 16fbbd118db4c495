#include "host/flatten/environment_map.hpp"

#include "host/fingerprint.hpp"
#include "host/flatten/piecewise_constant.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace glim {
namespace {

using std::numbers::pi;

// Beyond this number of texels, blocks of them make a cell.
constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 23;
constexpr std::uint32_t kMaxCellsAcross = 65536;  // indices of 16 bits

// Where light sampling joins BSDF sampling by MIS, it pays to leave the darker part of the map to the other one: Karlik et al., "MIS
// Compensation" (2019). A share of plain weights keeps every estimator without MIS unbiased.
constexpr double kPlainShare = 0.1;

// Mantissas of 18 bits and an exponent of 8: relative to the strongest channel each is off by 2^-18 at most.
uvec2 packTexel(const glm::vec3& color)
{
    constexpr int kBits = 18, kBias = 127;
    const float strongest = std::max({color.r, color.g, color.b});
    const int exponent = strongest > 0.0F ? std::ilogb(strongest) + 1 - kBits : -kBias;
    if (exponent <= -kBias) {
        return uvec2(0);
    }
    const auto mantissa = [exponent](float c) {
        return std::min(static_cast<std::uint32_t>(std::lround(std::ldexp(static_cast<double>(c), -exponent))), (1U << kBits) - 1);
    };
    const std::uint32_t r = mantissa(color.r), g = mantissa(color.g), b = mantissa(color.b);
    return {r | g << 18U, g >> 14U | b << 4U | static_cast<std::uint32_t>(exponent + kBias) << 22U};
}

// The mean of the bilinear interpolant over a texel, a filter (1, 6, 1) / 8 each way: no cell next to a light is without weight.
double meanOverTexel(const RadianceMap& map, std::uint32_t x, std::uint32_t y)
{
    const std::uint32_t left = x == 0 ? map.width - 1 : x - 1, right = x + 1 == map.width ? 0 : x + 1;
    const std::uint32_t above = y == 0 ? 0 : y - 1, below = std::min(y + 1, map.height - 1);
    const auto row = [&](std::uint32_t v) {
        const glm::vec3* texels = &map.texels[std::size_t{v} * map.width];
        return strongestChannel(texels[left]) + 6.0 * strongestChannel(texels[x]) + strongestChannel(texels[right]);
    };
    return (row(above) + 6.0 * row(y) + row(below)) / 64.0;
}

struct CellGrid {
    std::uint32_t block = 1, width = 0, height = 0;
};

CellGrid chooseCells(const RadianceMap& map)
{
    CellGrid grid;
    do {
        grid.width = (map.width + grid.block - 1) / grid.block;
        grid.height = (map.height + grid.block - 1) / grid.block;
        grid.block *= 2;
    } while (std::uint64_t{grid.width} * grid.height > kMaxCells || std::max(grid.width, grid.height) > kMaxCellsAcross);
    grid.block /= 2;
    return grid;
}

// sin^2 of half the polar angle at the lower edge of row `row`.
double halfSine2(std::uint32_t row, std::uint32_t rows) { return std::pow(std::sin(0.5 * pi * row / rows), 2.0); }

// Of a cell of the row, per cell: 2 pi (cos a - cos b) / columns, without cancellation at the poles.
double solidAngle(std::uint32_t row, const CellGrid& grid)
{
    const double a = pi * row / grid.height, b = pi * (row + 1) / grid.height;
    return 2.0 * pi / grid.width * 2.0 * std::sin(0.5 * (a + b)) * std::sin(0.5 * (b - a));
}

// What light paths carry of a map, in caustics: the radiance above a split T. The variance of light paths goes with the square of the flux
// that they carry, and that of camera paths with the integral of the square of what is left to them, min(L, T)^2. Where the derivative of
// the sum by T is 0, T is kSplit times the integral of L - T over the brighter directions. kSplit is 4 pi sr times the share of the scene's
// surfaces that caustics cover, of which a tenth is common, if light paths are a tenth of the samples.
constexpr double kSplit = 1.0;  // 1/sr
// And only if the integral of L^2 - min(L, T)^2 is more than this times the square of that of L. Without light paths, caustics that fill
// the view have about pi sr times the ratio for their relative variance. A studio of softboxes has .2, a uniform sky .08: their caustics
// have less noise than other light.
constexpr double kLeastGain = 1.0;  // 1/sr

struct BrightPart {
    double split = 0.0, integral = 0.0;  // 0: none
};

// Over the texels in bins by the upper half of their bits, brightest first.
BrightPart findBrightPart(const RadianceMap& map)
{
    struct Bin {
        double solidAngle = 0.0, integral = 0.0, squares = 0.0;
    };
    std::vector<Bin> bins(0x7f80);  // of finite numbers
    double integral = 0.0;
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const double omega = solidAngle(y, {1, map.width, map.height});
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double radiance = strongestChannel(map.texels[std::size_t{y} * map.width + x]);
            Bin& bin = bins[std::bit_cast<std::uint32_t>(static_cast<float>(radiance)) >> 16U];
            bin.solidAngle += omega;
            bin.integral += radiance * omega;
            bin.squares += radiance * radiance * omega;
            integral += radiance * omega;
        }
    }
    Bin above;
    BrightPart part;
    for (std::size_t i = bins.size(); i-- > 0;) {
        const auto most = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(i + 1) << 16U));  // of this bin
        if (part.split >= most) {
            break;
        }
        above.solidAngle += bins[i].solidAngle;
        above.integral += bins[i].integral;
        above.squares += bins[i].squares;
        part.split = kSplit * above.integral / (1.0 + kSplit * above.solidAngle);
    }
    part.integral = above.integral - part.split * above.solidAngle;
    const double squares = above.squares - part.split * part.split * above.solidAngle;
    return squares > kLeastGain * integral * integral ? part : BrightPart{};
}

std::vector<double> meansOfCells(const RadianceMap& map, const CellGrid& grid)
{
    std::vector<double> means(std::size_t{grid.width} * grid.height, 0.0);
    std::vector<std::uint32_t> counts(means.size(), 0);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        // A cell is where kernels look its direction up: its share of the map, not a whole number of texels.
        const std::size_t row =
            std::size_t{std::min(static_cast<std::uint32_t>((y + 0.5) * grid.height / map.height), grid.height - 1)} * grid.width;
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::size_t cell = row + std::min(static_cast<std::uint32_t>((x + 0.5) * grid.width / map.width), grid.width - 1);
            means[cell] += meanOverTexel(map, x, y);
            ++counts[cell];
        }
    }
    for (std::size_t i = 0; i < means.size(); ++i) {
        means[i] /= std::max(counts[i], 1U);
    }
    return means;
}

uvec4 rowBounds(std::uint32_t row, const CellGrid& grid)
{
    // Rows below the equator are measured from the lower pole; one across it too.
    const bool lower = 2 * row + 1 >= grid.height;
    const std::uint32_t from = lower ? grid.height - 1 - row : row;
    const auto bits = [](double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); };
    return {bits(halfSine2(from, grid.height)), bits(halfSine2(from + 1, grid.height)), bits(lower ? 1.0 : 0.0), 0};
}

uvec4 packCell(const PiecewiseConstantEntry& entry, double pdf)
{
    return {entry.first, entry.last, std::bit_cast<std::uint32_t>(static_cast<float>(pdf)), entry.searchBegin | entry.searchEnd << 16U};
}

// Cells of all rows, then two texels for each row: its entry among rows, and its bounds.
std::vector<uvec4> makeCells(const std::vector<double>& weights, const CellGrid& grid)
{
    std::vector<double> sums(grid.height);
    for (std::uint32_t row = 0; row < grid.height; ++row) {
        const auto begin = weights.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * grid.width);
        sums[row] = std::accumulate(begin, begin + grid.width, 0.0);
    }
    const std::vector<PiecewiseConstantEntry> rows = buildPiecewiseConstant(sums);
    std::vector<uvec4> cells;
    cells.reserve(weights.size() + 2 * std::size_t{grid.height});
    for (std::uint32_t row = 0; row < grid.height; ++row) {
        const double pdfOfRow = computeProbability(rows[row]) / solidAngle(row, grid);
        const std::span<const double> ofRow = std::span(weights).subspan(std::size_t{row} * grid.width, grid.width);
        for (const PiecewiseConstantEntry& cell : buildPiecewiseConstant(ofRow)) {
            cells.push_back(packCell(cell, pdfOfRow * computeProbability(cell)));
        }
    }
    for (std::uint32_t row = 0; row < grid.height; ++row) {
        cells.push_back(packCell(rows[row], 0.0));
        cells.push_back(rowBounds(row, grid));
    }
    return cells;
}

// Of the cells in which the interpolant exceeds the split somewhere.
std::vector<uvec4> makeBrightCells(const RadianceMap& map, const CellGrid& grid, double split)
{
    constexpr double kRounding = 1e-5;  // of packed texels
    std::map<std::uint32_t, double> weightOfCell;
    const auto add = [&](std::uint32_t x, std::uint32_t y, double weight) {
        // A texel may reach into several cells.
        const auto firstOf = [](std::uint64_t at, std::uint32_t cells, std::uint32_t texels) { return at * cells / texels; };
        const auto lastOf = [](std::uint64_t at, std::uint32_t cells, std::uint32_t texels) { return ((at + 1) * cells - 1) / texels; };
        for (auto row = firstOf(y, grid.height, map.height); row <= lastOf(y, grid.height, map.height); ++row) {
            for (auto column = firstOf(x, grid.width, map.width); column <= lastOf(x, grid.width, map.width); ++column) {
                weightOfCell[static_cast<std::uint32_t>(row * grid.width + column)] +=
                    weight * solidAngle(static_cast<std::uint32_t>(row), grid);
            }
        }
    };
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double excess = strongestChannel(map.texels[std::size_t{y} * map.width + x]) - split * (1.0 - kRounding);
            if (excess > 0.0) {  // in the texels next to it too, as in meanOverTexel
                const std::uint32_t left = x == 0 ? map.width - 1 : x - 1, right = x + 1 == map.width ? 0 : x + 1;
                for (const auto& [v, share] : {std::pair(y == 0 ? 0 : y - 1, 1.0), {y, 6.0}, {std::min(y + 1, map.height - 1), 1.0}}) {
                    add(left, v, share * excess);
                    add(x, v, 6.0 * share * excess);
                    add(right, v, share * excess);
                }
            }
        }
    }
    std::vector<double> weights;
    for (const auto& [cell, weight] : weightOfCell) {
        weights.push_back(weight);
    }
    std::vector<uvec4> cells;
    auto cell = weightOfCell.begin();
    for (const PiecewiseConstantEntry& entry : buildPiecewiseConstant(weights)) {
        const double pdf = computeProbability(entry) / solidAngle(cell->first / grid.width, grid);
        cells.emplace_back(entry.first, entry.last, cell->first, std::bit_cast<std::uint32_t>(static_cast<float>(pdf)));
        ++cell;
    }
    return cells;
}

}  // namespace

PackedEnvironment packEnvironmentMap(std::shared_ptr<const RadianceMap> source)
{
    PackedEnvironment packed;
    packed.source = std::move(source);
    const RadianceMap& map = *packed.source;
    const CellGrid grid = chooseCells(map);
    std::vector<double> weights = meansOfCells(map, grid);
    for (std::uint32_t row = 0; row < grid.height; ++row) {
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            packed.integral += weights[std::size_t{row} * grid.width + x] * solidAngle(row, grid);
        }
    }
    if (!(packed.integral > 0.0)) {
        return packed;
    }
    const double mean = packed.integral / (4.0 * pi);
    for (std::uint32_t row = 0; row < grid.height; ++row) {
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            double& weight = weights[std::size_t{row} * grid.width + x];
            const double compensated = std::max(weight - mean, 0.0);
            // Bilinear look-ups of a black cell's neighbours may reach into it: no weight is 0.
            weight = (std::max(weight, 1e-6 * mean) * kPlainShare + compensated * (1.0 - kPlainShare)) * solidAngle(row, grid);
        }
    }
    packed.texels.reserve(map.texels.size());
    for (const glm::vec3& texel : map.texels) {
        packed.texels.push_back(packTexel(texel));
    }
    packed.size = {map.width, map.height};
    packed.cellCount = {grid.width, grid.height};
    packed.cells = makeCells(weights, grid);
    if (const BrightPart bright = findBrightPart(map); bright.integral > 0.0) {
        packed.split = static_cast<float>(bright.split);
        packed.brightIntegral = bright.integral;
        packed.brightCells = makeBrightCells(map, grid, bright.split);
    }
    Fingerprint print;
    print.add(packed.texels);
    packed.fingerprint = print.state();
    return packed;
}

}  // namespace glim
