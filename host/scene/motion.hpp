// How things move while the shutter is open: transforms at keys, and what is between them.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace glim {

// Seconds after the frame's time: open <= 0 <= close, and not both 0.
struct Shutter {
    double open = 0.0, close = 0.0;

    bool operator==(const Shutter&) const = default;
};

// An affine transform as rotation * stretch, then a translation. The stretch is symmetric: with scales along the axes it is diagonal.
struct MotionKey {
    double time = 0.0;  // 0: the shutter opens; 1: it closes
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dmat3 stretch{1.0};

    bool operator==(const MotionKey&) const = default;
};

// Two keys or more, by time; two of the same time are a jump. Each rotation is less than a half turn from the one before.
using Motion = std::vector<MotionKey>;

// The parts of an invertible transform.
MotionKey splitTransform(const glm::dmat4& transform);

// Where the motion is between key `key` and the next one. Translation and stretch are linear, and the rotation turns evenly.
glm::dmat4 transformBetween(const Motion& motion, std::size_t key, double share);
glm::dmat4 transformAt(const Motion& motion, double time);

// The motion seen from there.
Motion relativeTo(const glm::dvec3& origin, Motion motion);

// In radians, from key `key` to the next one.
double turnAfter(const Motion& motion, std::size_t key);

// What moves: its transform at a time in seconds; nothing where it has no inverse.
using TransformAt = std::function<std::optional<glm::dmat4>(double)>;
// How far one transform is from another, in units of what is allowed.
using Deviation = std::function<double(const glm::dmat4&, const glm::dmat4&)>;

// A motion that deviates by at most 1, where kMaxMotionKeys allow it. `times`: in seconds, at which there are keys: the first and the last
// moment of the shutter, and moments at which the motion has a corner. Nothing if there is no inverse at some time.
std::optional<Motion> followMotion(const TransformAt& transformAt, const std::vector<double>& times, const Deviation& deviation);

inline constexpr std::size_t kMaxMotionKeys = 256;

}  // namespace glim
