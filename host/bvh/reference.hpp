// The builder's working data: boxes of four lanes, so that the compiler turns each loop over lanes into one vector instruction.
#pragma once

#include "host/bvh/bvh.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace glim {

// x, y, z and a fourth value.
struct alignas(16) Lanes {
    std::array<float, 4> v;
};

inline Lanes minOf(const Lanes& a, const Lanes& b)
{
    Lanes least;
    for (std::size_t k = 0; k < 4; ++k) {
        least.v[k] = std::min(a.v[k], b.v[k]);
    }
    return least;
}

inline Lanes maxOf(const Lanes& a, const Lanes& b)
{
    Lanes most;
    for (std::size_t k = 0; k < 4; ++k) {
        most.v[k] = std::max(a.v[k], b.v[k]);
    }
    return most;
}

// Starts empty.
struct LaneBox {
    Lanes lo = fill(std::numeric_limits<float>::max());
    Lanes hi = fill(-std::numeric_limits<float>::max());

    void grow(const LaneBox& other)
    {
        lo = minOf(lo, other.lo);
        hi = maxOf(hi, other.hi);
    }
    void grow(const Lanes& point)
    {
        lo = minOf(lo, point);
        hi = maxOf(hi, point);
    }
    // Each bound is halved first, because their difference could overflow.
    Lanes computeHalfExtent() const
    {
        Lanes extent;
        for (std::size_t k = 0; k < 4; ++k) {
            extent.v[k] = 0.5F * hi.v[k] - 0.5F * lo.v[k];
        }
        return extent;
    }
    // An eighth of the surface area; meaningless if the box is empty. In double, because squares of float extents overflow a float.
    double computeArea() const
    {
        const Lanes extent = computeHalfExtent();
        const double x = static_cast<double>(extent.v[0]), y = static_cast<double>(extent.v[1]);
        const double z = static_cast<double>(extent.v[2]);
        return x * y + y * z + z * x;
    }
    Box box() const { return {{lo.v[0], lo.v[1], lo.v[2]}, {hi.v[0], hi.v[1], hi.v[2]}}; }

private:
    static constexpr Lanes fill(float value) { return {{value, value, value, value}}; }
};

// A primitive's box. The fourth lanes hold its index as two 16-bit numbers: floats hold those exactly, and vector instructions process
// them at full speed (an integer's own bits could be a slow denormal).
struct Reference {
    LaneBox box;

    Reference() = default;
    Reference(const Box& b, std::uint32_t primitive)
    {
        box.lo = {{b.lo.x, b.lo.y, b.lo.z, static_cast<float>(primitive >> 16)}};
        box.hi = {{b.hi.x, b.hi.y, b.hi.z, static_cast<float>(primitive & 0xFFFFU)}};
    }
    std::uint32_t primitive() const { return static_cast<std::uint32_t>(box.lo.v[3]) << 16 | static_cast<std::uint32_t>(box.hi.v[3]); }
    // Each bound is halved first, because their sum could overflow.
    Lanes computeCentre() const
    {
        Lanes centre;
        for (std::size_t k = 0; k < 4; ++k) {
            centre.v[k] = 0.5F * box.lo.v[k] + 0.5F * box.hi.v[k];
        }
        return centre;
    }
};

struct NodeBounds {
    LaneBox box;      // around the primitives
    LaneBox centres;  // around the centres of their boxes

    void grow(const NodeBounds& other)
    {
        box.grow(other.box);
        centres.grow(other.centres);
    }
};

inline NodeBounds computeBounds(std::span<const Reference> references)
{
    NodeBounds bounds;
    for (const Reference& reference : references) {
        bounds.box.grow(reference.box);
        bounds.centres.grow(reference.computeCentre());
    }
    return bounds;
}

}  // namespace glim
