#include "host/flatten/place_instances.hpp"

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

glm::vec3 roundUp(const glm::dvec3& v)
{
    const auto up = [](double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); };
    return {up(v.x), up(v.y), up(v.z)};
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
    return data;
}

Box placeBoxes(const Placement& placement, std::span<const Box> parts)
{
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
    return roundUp(boundInverseError(placement, 3.0 * glm::dvec3(farthest)));
}

}  // namespace glim
