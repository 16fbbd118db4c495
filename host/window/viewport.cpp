#include "host/window/viewport.hpp"

#include "host/bvh/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace glim {
namespace {

constexpr double kLargestZoom = 64.0;

Viewport inTheMiddle(double zoom, const glm::uvec2& picture, const glm::uvec2& window)
{
    return {zoom, glm::floor(0.5 * (glm::dvec2(window) - zoom * glm::dvec2(picture)))};
}

// The place in the picture of a point of the window.
glm::dvec2 placeOf(const Viewport& viewport, const glm::dvec2& point) { return (point - viewport.corner) / viewport.zoom; }

// The pixels of a row or column whose centres lie between two places; where there is none, the one at the middle.
struct Span {
    std::uint32_t begin, end;
};
Span computeSpan(double low, double high, std::uint32_t count)
{
    const double last = static_cast<double>(count) - 1.0;
    const auto begin = static_cast<std::uint32_t>(std::clamp(std::ceil(low - 0.5), 0.0, last));
    const auto end = static_cast<std::uint32_t>(std::clamp(std::ceil(high - 0.5), 0.0, last + 1.0));
    if (begin < end) {
        return {begin, end};
    }
    const auto middle = static_cast<std::uint32_t>(std::clamp(std::floor(0.5 * (low + high)), 0.0, last));
    return {middle, middle + 1};
}

glm::vec3 meanOf(const PictureValues& picture, const Span& columns, const Span& rows)
{
    glm::vec3 sum(0.0F);
    for (std::uint32_t y = rows.begin; y < rows.end; ++y) {
        for (std::uint32_t x = columns.begin; x < columns.end; ++x) {
            sum += picture.values[std::size_t{y} * picture.size.x + x];
        }
    }
    const std::size_t count = std::size_t{rows.end - rows.begin} * (columns.end - columns.begin);
    return count == 1 ? sum : sum / static_cast<float>(count);
}

}  // namespace

Viewport fit(const glm::uvec2& picture, const glm::uvec2& window)
{
    const glm::dvec2 ratio = glm::dvec2(window) / glm::dvec2(picture);
    const double zoom = std::min(ratio.x, ratio.y);
    return inTheMiddle(std::min(zoom < 1.0 ? zoom : std::floor(zoom), kLargestZoom), picture, window);
}

Viewport actualSize(const glm::uvec2& picture, const glm::uvec2& window) { return inTheMiddle(1.0, picture, window); }

Viewport zoomAt(const Viewport& viewport, const glm::dvec2& point, double factor)
{
    const double zoom = std::clamp(viewport.zoom * factor, std::min(viewport.zoom, 1.0 / kLargestZoom), kLargestZoom);
    return {zoom, point - zoom * placeOf(viewport, point)};
}

std::optional<glm::uvec2> pixelAt(const Viewport& viewport, const glm::dvec2& point, const glm::uvec2& picture)
{
    const glm::dvec2 place = glm::floor(placeOf(viewport, point));
    if (place.x < 0.0 || place.y < 0.0 || place.x >= static_cast<double>(picture.x) || place.y >= static_cast<double>(picture.y)) {
        return std::nullopt;
    }
    return glm::uvec2(place);
}

Rectangle coveredBy(const Viewport& viewport, const glm::uvec2& picture, const glm::uvec2& window)
{
    // The pixels whose centres lie over the picture.
    const glm::dvec2 corner = viewport.corner, size = viewport.zoom * glm::dvec2(picture), end(window);
    Rectangle covered{glm::uvec2(glm::clamp(glm::ceil(corner - 0.5), glm::dvec2(0.0), end)),
                      glm::uvec2(glm::clamp(glm::ceil(corner + size - 0.5), glm::dvec2(0.0), end))};
    for (int k = 0; k < 2; ++k) {
        if (size[k] < 1.0 && corner[k] >= 0.0 && corner[k] < end[k]) {
            covered.low[k] = static_cast<std::uint32_t>(corner[k]);
            covered.high[k] = covered.low[k] + 1;
        }
    }
    return covered;
}

void layUnder(const PictureValues& picture, const Viewport& viewport, const glm::uvec2& window, bool averages,
              std::vector<glm::vec3>& values)
{
    values.resize(std::size_t{window.x} * window.y);
    const Rectangle covered = coveredBy(viewport, picture.size, window);
    // Half of what is averaged, in pixels of the window.
    const double half = averages && viewport.zoom < 1.0 ? 0.5 : 0.0;
    const auto spanAt = [&](std::uint32_t pixel, double corner, std::uint32_t count) {
        const double center = static_cast<double>(pixel) + 0.5 - corner;
        return computeSpan((center - half) / viewport.zoom, (center + half) / viewport.zoom, count);
    };
    std::vector<Span> columns;
    for (std::uint32_t x = covered.low.x; x < covered.high.x; ++x) {
        columns.push_back(spanAt(x, viewport.corner.x, picture.size.x));
    }
    parallelFor(covered.high.y - covered.low.y, std::thread::hardware_concurrency(), [&](std::size_t row) {
        const auto y = covered.low.y + static_cast<std::uint32_t>(row);
        const Span rows = spanAt(y, viewport.corner.y, picture.size.y);
        for (std::size_t i = 0; i < columns.size(); ++i) {
            values[std::size_t{y} * window.x + covered.low.x + i] = meanOf(picture, columns[i], rows);
        }
    });
}

}  // namespace glim
