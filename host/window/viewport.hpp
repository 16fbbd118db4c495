// Where a picture lies in a window: pure functions of places and sizes in pixels.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace glim {

struct Viewport {
    double zoom = 1.0;       // pixels of the window for the side of one of the picture
    glm::dvec2 corner{0.0};  // the place in the window of the picture's upper left corner
};

// The picture in the middle, as large as the window allows. If it is magnified, the zoom is a whole number.
Viewport fit(const glm::uvec2& picture, const glm::uvec2& window);
// The picture in the middle, a pixel for a pixel.
Viewport actualSize(const glm::uvec2& picture, const glm::uvec2& window);
// Magnifies by `factor`, within 1/64 and 64; the point of the window stays over its point of the picture.
Viewport zoomAt(const Viewport& viewport, const glm::dvec2& point, double factor);

// The picture's pixel under a point of the window; nothing beside the picture.
std::optional<glm::uvec2> pixelAt(const Viewport& viewport, const glm::dvec2& point, const glm::uvec2& picture);

// The part of the window that shows the picture: its pixels from `low` to `high`, without `high`. A picture that is thinner than a pixel
// of the window has one.
struct Rectangle {
    glm::uvec2 low{0}, high{0};
};
Rectangle coveredBy(const Viewport& viewport, const glm::uvec2& picture, const glm::uvec2& window);

// A picture's values, row by row.
struct PictureValues {
    glm::uvec2 size{0};
    std::span<const glm::vec3> values;
};
// The picture's values under the window's pixels, row by row; those beside it are left as they are. A pixel of the window has the value
// of the picture's pixel at its centre. If the picture is made smaller and `averages`, it has the mean of all that have their centre in it.
void layUnder(const PictureValues& picture, const Viewport& viewport, const glm::uvec2& window, bool averages,
              std::vector<glm::vec3>& values);

}  // namespace glim
