// Boxes in double precision.
#pragma once

#include <glm/glm.hpp>

#include <limits>

namespace glim {

// Empty at first.
struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }

    void add(const Bounds& other)
    {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
};

// Whether they have more in common than faces.
inline bool overlap(const Bounds& a, const Bounds& b)
{
    return glm::all(glm::lessThan(a.low, b.high)) && glm::all(glm::lessThan(b.low, a.high));
}

// Whether they have anything in common.
inline bool touch(const Bounds& a, const Bounds& b)
{
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

}  // namespace glim
