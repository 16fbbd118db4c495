#include "host/scene/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace glim {
namespace {

// The rotation next to a matrix of positive determinant. Higham, "Computing the Polar Decomposition", 1986: Newton's iteration, scaled by
// determinants, which converges quadratically.
glm::dmat3 nearestRotation(glm::dmat3 m)
{
    constexpr int kMaxSteps = 60;
    for (int i = 0; i < kMaxSteps; ++i) {
        const double scale = 1.0 / std::cbrt(glm::determinant(m));
        const glm::dmat3 next = 0.5 * (scale * m + glm::transpose(glm::inverse(scale * m)));
        const glm::dmat3 step = next - m;
        m = next;
        if (glm::dot(step[0], step[0]) + glm::dot(step[1], step[1]) + glm::dot(step[2], step[2]) < 1e-28) {
            break;
        }
    }
    return m;
}

glm::dmat4 join(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dmat3& stretch)
{
    glm::dmat4 transform(glm::mat3_cast(rotation) * stretch);
    transform[3] = glm::dvec4(translation, 1.0);
    return transform;
}

// From one moment to the next.
struct Interval {
    double begin, end;  // seconds
    glm::dmat4 first, last;
    double deviation = 0.0;
};

// Follows one motion from moment to moment.
class Follower {
public:
    Follower(const TransformAt& transformAt, const Deviation& deviation)
        : transformAt_(transformAt),
          deviation_(deviation)
    {}

    bool add(double begin, double end);
    bool splitWorst();
    Motion keys() const;
    std::size_t size() const { return intervals_.size(); }
    double deviation() const { return std::ranges::max_element(intervals_, {}, &Interval::deviation)->deviation; }

private:
    std::optional<Interval> measure(double begin, double end, const glm::dmat4& first, const glm::dmat4& last) const;

    const TransformAt& transformAt_;
    const Deviation& deviation_;
    std::vector<Interval> intervals_;  // in order
};

Motion keysOf(const glm::dmat4& first, const glm::dmat4& last)
{
    Motion keys{splitTransform(first), splitTransform(last)};
    keys.back().time = 1.0;
    return keys;
}

std::optional<Interval> Follower::measure(double begin, double end, const glm::dmat4& first, const glm::dmat4& last) const
{
    Interval interval{begin, end, first, last};
    if (std::nextafter(begin, end) >= end) {
        return interval;  // a jump
    }
    const Motion keys = keysOf(first, last);
    for (const double share : {0.25, 0.5, 0.75}) {
        const std::optional<glm::dmat4> exact = transformAt_(begin + share * (end - begin));
        if (!exact) {
            return std::nullopt;
        }
        interval.deviation = std::max(interval.deviation, deviation_(*exact, transformBetween(keys, 0, share)));
    }
    return interval;
}

// False where there is no inverse.
bool Follower::add(double begin, double end)
{
    const std::optional<glm::dmat4> first = transformAt_(begin), last = transformAt_(end);
    const std::optional<Interval> interval = first && last ? measure(begin, end, *first, *last) : std::nullopt;
    if (interval) {
        intervals_.push_back(*interval);
    }
    return interval.has_value();
}

// Halves the interval that deviates most. False where there is no inverse.
bool Follower::splitWorst()
{
    const auto worst = std::ranges::max_element(intervals_, {}, &Interval::deviation);
    const double middle = 0.5 * (worst->begin + worst->end);
    const std::optional<glm::dmat4> there = transformAt_(middle);
    const auto left = there ? measure(worst->begin, middle, worst->first, *there) : std::nullopt;
    const auto right = there ? measure(middle, worst->end, *there, worst->last) : std::nullopt;
    if (!left || !right) {
        return false;
    }
    *worst = *left;
    intervals_.insert(std::next(worst), *right);
    return true;
}

Motion Follower::keys() const
{
    const double open = intervals_.front().begin, seconds = intervals_.back().end - open;
    Motion motion;
    const auto add = [&](double time, const glm::dmat4& transform) {
        motion.push_back(splitTransform(transform));
        motion.back().time = (time - open) / seconds;
    };
    for (const Interval& interval : intervals_) {
        add(interval.begin, interval.first);
    }
    add(intervals_.back().end, intervals_.back().last);
    for (std::size_t i = 1; i < motion.size(); ++i) {  // the shorter way round
        motion[i].rotation = glm::dot(motion[i - 1].rotation, motion[i].rotation) < 0.0 ? -motion[i].rotation : motion[i].rotation;
    }
    return motion;
}

}  // namespace

MotionKey splitTransform(const glm::dmat4& transform)
{
    const glm::dmat3 linear(transform);
    const glm::dmat3 rotation = nearestRotation(glm::determinant(linear) < 0.0 ? -linear : linear);
    const glm::dmat3 stretch = glm::transpose(rotation) * linear;
    return {0.0, glm::dvec3(transform[3]), glm::normalize(glm::quat_cast(rotation)), 0.5 * (stretch + glm::transpose(stretch))};
}

glm::dmat4 transformBetween(const Motion& motion, std::size_t key, double share)
{
    const MotionKey &a = motion[key], &b = motion[key + 1];
    return join(glm::mix(a.translation, b.translation, share), glm::slerp(a.rotation, b.rotation, share),
                a.stretch + share * (b.stretch - a.stretch));
}

glm::dmat4 transformAt(const Motion& motion, double time)
{
    const auto after = std::ranges::upper_bound(motion, time, {}, &MotionKey::time);
    const auto key = std::clamp<std::ptrdiff_t>(after - motion.begin() - 1, 0, static_cast<std::ptrdiff_t>(motion.size()) - 2);
    const MotionKey &a = motion[static_cast<std::size_t>(key)], &b = motion[static_cast<std::size_t>(key) + 1];
    const double share = b.time > a.time ? std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0) : 1.0;
    return transformBetween(motion, static_cast<std::size_t>(key), share);
}

Motion relativeTo(const glm::dvec3& origin, Motion motion)
{
    for (MotionKey& key : motion) {
        key.translation -= origin;
    }
    return motion;
}

double turnAfter(const Motion& motion, std::size_t key)
{
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(motion[key].rotation, motion[key + 1].rotation))));
}

std::optional<Motion> followMotion(const TransformAt& transformAt, const std::vector<double>& times, const Deviation& deviation)
{
    Follower follower(transformAt, deviation);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        if (!follower.add(times[i], times[i + 1])) {
            return std::nullopt;
        }
    }
    while (follower.size() + 1 < kMaxMotionKeys && follower.deviation() > 1.0) {
        if (!follower.splitWorst()) {
            return std::nullopt;
        }
    }
    return follower.keys();
}

}  // namespace glim
