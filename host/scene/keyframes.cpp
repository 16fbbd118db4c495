#include "host/scene/keyframes.hpp"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace glim {
namespace {

enum Part : std::size_t { kIncoming, kValue, kOutgoing };

std::vector<double> partOf(const Keyframes& keyframes, std::size_t key, Part part)
{
    const bool spline = keyframes.interpolation == Interpolation::CubicSpline;
    const std::size_t first = (spline ? 3 * key + part : key) * keyframes.width;
    const auto begin = keyframes.values.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(keyframes.width)};
}

// Zero stays zero.
std::vector<double> unit(const std::vector<double>& rotation)
{
    const double length = glm::length(glm::dvec4(rotation[0], rotation[1], rotation[2], rotation[3]));
    const double scale = length > 0.0 ? 1.0 / length : 1.0;
    return {scale * rotation[0], scale * rotation[1], scale * rotation[2], scale * rotation[3]};
}

// By the shorter way round.
std::vector<double> slerp(const std::vector<double>& from, const std::vector<double>& to, double share)
{
    const std::vector<double> a = unit(from), b = unit(to);
    const glm::dquat between = glm::slerp(glm::dquat(a[3], a[0], a[1], a[2]), glm::dquat(b[3], b[0], b[1], b[2]), share);
    return {between.x, between.y, between.z, between.w};
}

std::vector<double> mix(const std::vector<double>& a, const std::vector<double>& b, double share)
{
    std::vector<double> mixed(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        mixed[i] = (1.0 - share) * a[i] + share * b[i];
    }
    return mixed;
}

// Hermite's basis; tangents are per second.
std::vector<double> splineBetween(const Keyframes& keyframes, std::size_t key, double share, double seconds)
{
    const std::vector<double> from = partOf(keyframes, key, kValue), leaving = partOf(keyframes, key, kOutgoing);
    const std::vector<double> arriving = partOf(keyframes, key + 1, kIncoming), to = partOf(keyframes, key + 1, kValue);
    const double t = share, t2 = t * t, t3 = t2 * t;
    std::vector<double> value(keyframes.width);
    for (std::size_t i = 0; i < value.size(); ++i) {
        value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * from[i] + seconds * (t3 - 2.0 * t2 + t) * leaving[i] + (3.0 * t2 - 2.0 * t3) * to[i] +
                   seconds * (t3 - t2) * arriving[i];
    }
    return value;
}

std::vector<double> valueBetween(const Keyframes& keyframes, std::size_t key, double seconds)
{
    const double interval = keyframes.times[key + 1] - keyframes.times[key];
    const double share = (seconds - keyframes.times[key]) / interval;
    if (keyframes.interpolation == Interpolation::Step) {
        return partOf(keyframes, key, kValue);
    }
    if (keyframes.interpolation == Interpolation::CubicSpline) {
        return splineBetween(keyframes, key, share, interval);
    }
    const std::vector<double> from = partOf(keyframes, key, kValue), to = partOf(keyframes, key + 1, kValue);
    return keyframes.rotation ? slerp(from, to, share) : mix(from, to, share);
}

}  // namespace

std::vector<double> valueAt(const Keyframes& keyframes, double seconds)
{
    const std::vector<double>& times = keyframes.times;
    const auto next = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), seconds) - times.begin());
    const std::vector<double> value = next == 0              ? partOf(keyframes, 0, kValue)
                                      : next == times.size() ? partOf(keyframes, next - 1, kValue)
                                                             : valueBetween(keyframes, next - 1, seconds);
    return keyframes.rotation ? unit(value) : value;
}

}  // namespace glim
