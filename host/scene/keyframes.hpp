// A property that changes over time, as defined in glTF 2.0, appendix C.
#pragma once

#include <cstddef>
#include <vector>

namespace glim {

enum class Interpolation { Step, Linear, CubicSpline };

struct Keyframes {
    Interpolation interpolation = Interpolation::Linear;
    bool rotation = false;         // values are quaternions, x y z w
    std::size_t width = 1;         // numbers per value
    std::vector<double> times;     // seconds, not decreasing; at least one. The value jumps where two are equal
    std::vector<double> values{};  // a value per time; of a cubic spline its incoming tangent, the value and its outgoing tangent
};

// The value at a time. Before the first time it is the first value, after the last time the last one. Rotations have unit length.
std::vector<double> valueAt(const Keyframes& keyframes, double seconds);

}  // namespace glim
