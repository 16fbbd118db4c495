#include "host/flatten/place_instances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

// A bound of the relative error of each term of a transform in float32: its matrix is rounded, then a product and three sums; so is the
// inverse, which was rounded by itself. Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 3.1, with n = 8.
constexpr double kGamma = 8.0 * 0x1p-24 / (1.0 - 8.0 * 0x1p-24);

glm::dmat3 absolute(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

glm::dvec3 farthestCorner(const Box& box) { return glm::max(glm::abs(glm::dvec3(box.lo)), glm::abs(glm::dvec3(box.hi))); }

// In the scene's space: the error of a point that is taken from the scene, where its coordinates are at most `farthest`, to the mesh.
glm::dvec3 boundInverseError(const Placement& placement, const glm::dvec3& farthest)
{
    const glm::dmat3 inverse = glm::inverse(placement.linear);
    return absolute(placement.linear) * (kGamma * (absolute(inverse) * farthest + glm::abs(inverse * placement.translation)));
}

// As kGamma, of a motion: its keys are rounded and mixed, its rotation is made of a quaternion and its stretch inverted by cofactors, in
// float32.
constexpr double kMovingGamma = 48.0 * 0x1p-24;

// How much an inverse by cofactors may magnify the relative errors of a matrix's entries: 1 if it is diagonal. Higham, "Accuracy and
// Stability of Numerical Algorithms", 2002, section 7.2, and the permanent of absolute values for the cofactors.
double conditionOf(const glm::dmat3& stretch)
{
    const glm::dmat3 a = absolute(stretch), both = absolute(glm::inverse(stretch)) * a;
    const double permanent = a[0][0] * (a[1][1] * a[2][2] + a[1][2] * a[2][1]) + a[1][0] * (a[0][1] * a[2][2] + a[0][2] * a[2][1]) +
                             a[2][0] * (a[0][1] * a[1][2] + a[0][2] * a[1][1]);
    const glm::dvec3 sums = both * glm::dvec3(1.0);
    return std::max({sums.x, sums.y, sums.z}) * std::pow(permanent / std::abs(glm::determinant(stretch)), 2.0);
}

// The longest that the stretch makes a vector that is at most `farthest` long.
double stretched(const glm::dmat3& stretch, double farthest)
{
    return std::sqrt(glm::dot(stretch[0], stretch[0]) + glm::dot(stretch[1], stretch[1]) + glm::dot(stretch[2], stretch[2])) * farthest;
}

// In the scene's space: how far a point of the mesh that is at most `ofMesh` from its origin, and a point of the scene that is at most
// `ofScene` from that one's, may be from their places.
double boundMovingError(const PlacedMotion& motion, double ofMesh, double ofScene)
{
    double bound = 0.0;
    for (const MotionKey& key : motion.keys) {
        const double placed = stretched(key.stretch, ofMesh + glm::length(motion.pivot)) + glm::length(key.translation);
        bound = std::max(bound, conditionOf(key.stretch) * (placed + ofScene + glm::length(key.translation)));
    }
    return kMovingGamma * bound;
}

// Of the parts' points from the mesh's origin.
double reachOf(std::span<const Box> parts)
{
    double farthest = 0.0;
    for (const Box& part : parts) {
        farthest = std::max(farthest, glm::length(farthestCorner(part)));
    }
    return farthest;
}

// How far a point that is at most `farthest` from the pivot may be from the chord between two places of it, `share` of the way from key
// `key` to the next one apart: an eighth of share^2 times the greatest acceleration.
double boundSagitta(const Motion& keys, std::size_t key, double share, double farthest)
{
    const glm::dmat3 &from = keys[key].stretch, &to = keys[key + 1].stretch;
    const double turn = turnAfter(keys, key), length = std::max(stretched(from, farthest), stretched(to, farthest));
    return share * share / 8.0 * (turn * turn * length + 2.0 * turn * stretched(to - from, farthest));
}

glm::vec3 roundUp(const glm::dvec3& v)
{
    const auto up = [](double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); };
    return {up(v.x), up(v.y), up(v.z)};
}

// Where the motion's transform places the mesh.
Placement placeBy(const glm::dmat4& transform, const glm::dvec3& pivot)
{
    Placement placement;
    placement.linear = glm::dmat3(transform);
    placement.translation = placement.linear * pivot + glm::dvec3(transform[3]);
    return placement;
}

// Between two keys.
Box sweepBoxes(const PlacedMotion& motion, std::size_t key, std::span<const Box> parts)
{
    constexpr double kStep = 0.125;  // radians
    const int steps = 1 + static_cast<int>(turnAfter(motion.keys, key) / kStep);
    Box swept = kEmptyBox;
    for (int i = 0; i <= steps; ++i) {
        const glm::dmat4 transform = transformBetween(motion.keys, key, static_cast<double>(i) / steps);
        swept = unite(swept, placeBoxes(placeBy(transform, motion.pivot), parts));
    }
    const double reach = reachOf(parts) + glm::length(motion.pivot);
    const glm::vec3 margin = roundUp(glm::dvec3(boundSagitta(motion.keys, key, 1.0 / steps, reach)));
    return {swept.lo - margin, swept.hi + margin};
}

Box sweepBoxes(const PlacedMotion& motion, std::span<const Box> parts)
{
    Box swept = kEmptyBox;
    for (std::size_t key = 0; key + 1 < motion.keys.size(); ++key) {
        swept = unite(swept, sweepBoxes(motion, key, parts));
    }
    return swept;
}

}  // namespace

std::array<glm::vec4, 3> meshFromScene(const Placement& placement)
{
    const glm::dmat3 inverse = glm::inverse(placement.linear);
    const glm::dvec3 translation = -(inverse * placement.translation);
    std::array<glm::vec4, 3> rows;
    for (int k = 0; k < 3; ++k) {
        rows[static_cast<std::size_t>(k)] = glm::vec4(glm::dvec4(inverse[0][k], inverse[1][k], inverse[2][k], translation[k]));
    }
    return rows;
}

InstanceData placeInstance(const Placement& placement, const Box& meshBox)
{
    InstanceData data{};
    data.column0 = glm::vec3(placement.linear[0]);
    data.column1 = glm::vec3(placement.linear[1]);
    data.column2 = glm::vec3(placement.linear[2]);
    data.translation = glm::vec3(placement.translation);
    data.mirrors = glm::determinant(placement.linear) < 0.0 ? 1 : 0;
    const glm::dvec3 placed = absolute(placement.linear) * farthestCorner(meshBox) + glm::abs(placement.translation);
    data.errorBound = roundUp(boundInverseError(placement, placed) + kGamma * placed);
    if (placement.motion) {
        data.errorBound = roundUp(glm::dvec3(boundMovingError(*placement.motion, glm::length(farthestCorner(meshBox)), 0.0)));
    }
    return data;
}

Box placeBoxes(const Placement& placement, std::span<const Box> parts)
{
    if (placement.motion) {
        return sweepBoxes(*placement.motion, parts);
    }
    Box placed = kEmptyBox;
    for (const Box& part : parts) {
        const glm::dvec3 low(part.lo), high(part.hi);
        const glm::dvec3 center = placement.linear * (0.5 * (low + high)) + placement.translation;
        const glm::dvec3 extent = absolute(placement.linear) * (0.5 * (high - low));
        placed.lo = glm::min(placed.lo, -roundUp(extent - center));
        placed.hi = glm::max(placed.hi, roundUp(center + extent));
    }
    return placed;
}

glm::vec3 boundRayError(const Placement& placement, const glm::vec3& farthest)
{
    // Once for the origin; the way from there to a surface is at most twice as long on each axis.
    if (placement.motion) {
        return roundUp(glm::dvec3(boundMovingError(*placement.motion, 0.0, 3.0 * glm::length(glm::dvec3(farthest)))));
    }
    return roundUp(boundInverseError(placement, 3.0 * glm::dvec3(farthest)));
}

}  // namespace glim
