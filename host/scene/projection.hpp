// How a picture lies on the image plane of its camera, and what the lens does to straight lines: OpenCV's camera models.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace glim {

// Pixels. The picture's upper left corner is (0, 0), its lower right one `size`; so the middle of the first pixel is (.5, .5).
struct Intrinsics {
    glm::dvec2 focal{1.0};   // focal length
    glm::dvec2 center{0.0};  // principal point
    glm::dvec2 size{1.0};    // of the picture

    bool operator==(const Intrinsics&) const = default;
};

// A rectangle of a picture, in pixels; `corner`: its upper left one.
struct Crop {
    glm::uvec2 corner{0}, size{1};
    glm::uvec2 whole{1};  // the picture's size

    bool operator==(const Crop&) const = default;
};

struct Projection {
    enum class Model { Straight, RadialTangential, Fisheye, Equirectangular };

    Model model = Model::Straight;
    std::optional<Intrinsics> intrinsics;  // absent: the camera's field of view, and the picture's middle
    glm::dvec2 shift{0.0};                 // of the picture on its plane, right and up, in units of its longer side
    // RadialTangential: k1, k2, p1, p2, k3, k4, k5, k6, as OpenCV orders them. Fisheye: k1 to k4.
    std::array<double, 8> distortion{};
    std::optional<Crop> crop;  // all that is rendered

    bool operator==(const Projection&) const = default;
};

// The greatest tangent of the angle from the axis, or for a fisheye the greatest angle (at most pi), up to which what is farther from the
// axis is farther from it in the picture as well; tangential distortion is left out.
double findEnd(const Projection& projection);

}  // namespace glim
