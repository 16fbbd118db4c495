#include "host/bench/bootstrap.hpp"

#include "host/measure/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace glim {
namespace {

constexpr std::size_t kDraws = 2000;
constexpr double kOutside = 0.05;  // the probability that an interval may miss

Draw everyRender(const std::vector<std::size_t>& sizes)
{
    Draw draw;
    for (const std::size_t size : sizes) {
        draw.emplace_back(size);
        std::iota(draw.back().begin(), draw.back().end(), std::size_t{0});
    }
    return draw;
}

// The figure without each render of `group` in turn.
std::vector<double> leaveOneOut(const Draw& all, std::size_t group, const Figure& figure)
{
    std::vector<double> figures;
    for (std::size_t i = 0; i < all[group].size(); ++i) {
        Draw draw = all;
        draw[group].erase(draw[group].begin() + static_cast<std::ptrdiff_t>(i));
        figures.push_back(figure(draw));
    }
    return figures;
}

double meanOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double findAcceleration(const Draw& all, const Figure& figure)
{
    double squares = 0.0, cubes = 0.0;
    for (std::size_t group = 0; group < all.size(); ++group) {
        const std::vector<double> figures = leaveOneOut(all, group, figure);
        const double mean = meanOf(figures), n = static_cast<double>(figures.size());
        for (const double value : figures) {
            const double influence = (n - 1.0) * (mean - value);
            squares += influence * influence / (n * n);
            cubes += influence * influence * influence / (n * n * n);
        }
    }
    return squares > 0.0 ? cubes / (6.0 * squares * std::sqrt(squares)) : 0.0;
}

std::vector<double> drawFigures(const std::vector<std::size_t>& sizes, const Figure& figure)
{
    std::mt19937_64 random(1);
    std::vector<double> figures;
    Draw draw = everyRender(sizes);
    for (std::size_t i = 0; i < kDraws; ++i) {
        for (std::vector<std::size_t>& group : draw) {
            std::generate(group.begin(), group.end(), [&] { return random() % group.size(); });
        }
        figures.push_back(figure(draw));
    }
    std::sort(figures.begin(), figures.end());
    return figures;
}

double normalShare(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normalQuantile(double share) { return share < 0.5 ? -twoSidedLimit(2.0 * share) : twoSidedLimit(2.0 - 2.0 * share); }

// The quantile of sorted figures, interpolated between neighbours.
double quantile(const std::vector<double>& figures, double share)
{
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(figures.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, figures.size() - 1);
    return std::lerp(figures[below], figures[above], place - static_cast<double>(below));
}

}  // namespace

Interval bootstrap(const std::vector<std::size_t>& sizes, const Figure& figure)
{
    const Draw all = everyRender(sizes);
    const double value = figure(all), unknown = std::numeric_limits<double>::quiet_NaN();
    bool finite = std::isfinite(value);
    const std::vector<double> figures = drawFigures(sizes, [&](const Draw& draw) {
        const double drawn = figure(draw);
        finite = finite && std::isfinite(drawn);
        return std::isfinite(drawn) ? drawn : 0.0;
    });
    if (!finite) {
        return {value, unknown, unknown};
    }
    const auto below = std::lower_bound(figures.begin(), figures.end(), value) - figures.begin();
    const auto notAbove = std::upper_bound(figures.begin(), figures.end(), value) - figures.begin();
    const double share = 0.5 * static_cast<double>(below + notAbove) / static_cast<double>(kDraws);
    const double shift = normalQuantile(std::clamp(share, 1.0 / kDraws, 1.0 - 1.0 / kDraws));
    const double acceleration = findAcceleration(all, figure);
    const double n = static_cast<double>(*std::min_element(sizes.begin(), sizes.end()));
    const double halfWidth = std::sqrt(n / (n - 1.0)) * studentLimit(kOutside, *std::min_element(sizes.begin(), sizes.end()) - 1);
    const auto end = [&](double z) { return quantile(figures, normalShare(shift + (shift + z) / (1.0 - acceleration * (shift + z)))); };
    return {value, end(-halfWidth), end(halfWidth)};
}

double jackknifeError(std::size_t size, const Figure& figure)
{
    const std::vector<double> figures = leaveOneOut(everyRender({size}), 0, figure);
    const double mean = meanOf(figures), n = static_cast<double>(size);
    const double squares = std::accumulate(figures.begin(), figures.end(), 0.0,
                                           [mean](double sum, double value) { return sum + (value - mean) * (value - mean); });
    return std::sqrt(squares * (n - 1.0) / n);
}

}  // namespace glim
