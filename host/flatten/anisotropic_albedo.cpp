#include "host/flatten/albedo_table.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/flatten/albedo_parts.hpp"
#include "shaders/shared/microfacets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

namespace glim {
namespace {

using std::numbers::pi;

constexpr std::size_t kCosines = kAnisotropicCosines, kRatios = kAnisotropicRatios, kAlphas = kAnisotropicAlphas;

// In the place of 0 at the ends of the table's axes: what the functions tend to.
constexpr double kMinSeen = 1e-4, kMinRatio = 1e-3, kMinAnisotropicAlpha = 1e-3;

// Half circles of azimuths, as cosine, sine and weight, with more nodes at their ends, and nodes in (0, 1) with more at 0.
struct Nodes {
    Nodes()
    {
        const GaussRule azimuthRule(28), slopeRule(8);
        for (std::size_t i = 0; i < azimuthRule.nodes.size(); ++i) {
            const double t = azimuthRule.nodes[i], phi = pi / 16.0 * t * (15.0 - 10.0 * t * t + 3.0 * t * t * t * t);
            const double weight = 15.0 / 16.0 * pi * (1.0 - t * t) * (1.0 - t * t) * azimuthRule.weights[i];
            azimuths.emplace_back(std::cos(phi), std::sin(phi), weight);
            azimuths.emplace_back(-std::cos(phi), -std::sin(phi), weight);
        }
        for (std::size_t i = 0; i < slopeRule.nodes.size(); ++i) {
            const double s = 0.5 * (slopeRule.nodes[i] + 1.0);
            slopes.emplace_back(s * s, s * slopeRule.weights[i]);
        }
    }

    std::vector<glm::dvec3> azimuths;
    std::vector<glm::dvec2> slopes;
};

// a + b and b (lib/bsdf/multiple_scattering.glsl) of the direction v: as integrateAlbedo in albedo_table.cpp, with slopes alpha tan(beta)
// at azimuths about that of the stretched v. In terms of w = tan(beta / 2) the integrand is rational but for roots.
glm::dvec2 integrateAnisotropicAlbedo(const Nodes& nodes, const glm::dvec3& v, const glm::dvec2& alpha)
{
    const double facingLength = glm::length(alpha * glm::dvec2(v)), stretchedV = stretchedLength(v, alpha);
    const glm::dvec2 facing = facingLength > 0.0 ? alpha * glm::dvec2(v) / facingLength : glm::dvec2(1.0, 0.0);
    glm::dvec2 sum(0.0);
    for (const glm::dvec3& azimuth : nodes.azimuths) {
        const glm::dvec2 slope =
            alpha * glm::dvec2(facing.x * azimuth.x - facing.y * azimuth.y, facing.y * azimuth.x + facing.x * azimuth.y);
        const double width = glm::length(slope), across = glm::dot(glm::dvec2(v), slope) / width;
        // Where the reflection of v is at the horizon: tan(beta) = (1 + sine) / (width cosine), of v's angle in the plane of this azimuth.
        const double length = glm::length(glm::dvec2(across, v.z)), sine = across / length, cosine = v.z / length;
        const double rise = sine > 0.0 ? 1.0 + sine : cosine * cosine / (1.0 - sine);
        const double hypotenuse = glm::length(glm::dvec2(rise, width * cosine)), cosEnd = width * cosine / hypotenuse;
        const double end = rise / hypotenuse / (1.0 + cosEnd), beyondEnd = 2.0 * cosEnd / (1.0 + cosEnd);  // w and 1 - w^2
        for (const glm::dvec2& node : nodes.slopes) {
            const double w = end * (1.0 - node.x), rest = beyondEnd + end * end * node.x * (2.0 - node.x), whole = 1.0 + w * w;
            const double hz = rest / glm::length(glm::dvec2(rest, 2.0 * width * w)), tangent = 2.0 * w / rest;
            const double vh = hz * (v.z + tangent * width * across);
            const glm::dvec3 l = 2.0 * vh * hz * glm::dvec3(tangent * slope, 1.0) - v;
            if (!(l.z > 0.0) || !(vh > 0.0)) {
                continue;
            }
            // F G2 (v.h) / (v.z h.z) and sin(beta) cos(beta) / pi dbeta dphi
            const double visible = 2.0 * vh * l.z / (hz * (stretchedV * l.z + stretchedLength(l, alpha) * v.z));
            const double measure = azimuth.z * end * node.y * 4.0 * w * rest / (pi * whole * whole * whole);
            sum += glm::dvec2(1.0, fifthPower(1.0 - std::min(vh, 1.0))) * (visible * measure);
        }
    }
    return sum;
}

double share(std::size_t i, std::size_t count) { return static_cast<double>(i) / static_cast<double>(count - 1); }

double powerOfShare(std::size_t i, std::size_t count) { return std::pow(share(i, count), 4.0 / 3.0); }

// E and c (scene_types.h).
glm::dvec2 entryOf(const Nodes& nodes, double seen, double narrow, double wide, double alphaX)
{
    const double along = wide * alphaX, alphaY = narrow * along, squares = alphaX * alphaX - alphaY * alphaY;
    const double cos2 = squares > 1e-12 * alphaX * alphaX ? std::clamp((along * along - alphaY * alphaY) / squares, 0.0, 1.0) : 1.0;
    const double z2 = seen * seen * along * along / ((1.0 - seen) * (1.0 + seen) + seen * seen * along * along);
    const double sine = std::sqrt(1.0 - z2), z = std::sqrt(z2);
    const glm::dvec3 v(sine * std::sqrt(cos2), sine * std::sqrt(1.0 - cos2), z);
    const glm::dvec2 albedo = integrateAnisotropicAlbedo(nodes, v, {alphaX, alphaY});
    return {rounded(albedo.x), rounded((1.0 - std::pow(albedo.y / albedo.x, 0.2)) * seen / z)};
}

std::size_t indexOf(std::size_t seen, std::size_t narrow, std::size_t wide, std::size_t alpha)
{
    return seen + kCosines * (narrow + kRatios * (wide + kRatios * alpha));
}

std::vector<glm::dvec2> makeEntries()
{
    const Nodes nodes;
    std::vector<glm::dvec2> entries(kAnisotropicAlbedos);
    parallelFor(kRatios * kRatios * kAlphas, std::thread::hardware_concurrency(), [&](std::size_t row) {
        const double narrow = std::max(share(row % kRatios, kRatios), kMinRatio);
        const double wide = std::max(share(row / kRatios % kRatios, kRatios), kMinRatio);
        const double alpha = std::max(powerOfShare(row / (kRatios * kRatios), kAlphas), kMinAnisotropicAlpha);
        for (std::size_t i = 0; i < kCosines; ++i) {
            entries[row * kCosines + i] = entryOf(nodes, std::max(powerOfShare(i, kCosines), kMinSeen), narrow, wide, alpha);
        }
    });
    return entries;
}

// Between which two steps of an axis a number lies.
struct Cell {
    Cell(double x, std::size_t count)
        : first(std::min(static_cast<std::size_t>(x * static_cast<double>(count - 1)), count - 2)),
          weight(x * static_cast<double>(count - 1) - static_cast<double>(first))
    {}

    std::size_t first;
    double weight;
};

// a + b and b as kernels look them up (fetchAnisotropicAlbedo).
glm::dvec2 lookUp(const std::vector<glm::dvec2>& entries, const glm::dvec3& w, const glm::dvec2& alpha)
{
    const double stretched = stretchedLength(w, alpha), along = glm::length(alpha * glm::dvec2(w)) / glm::length(glm::dvec2(w));
    const Cell seen(std::pow(w.z / stretched, 0.75), kCosines), narrow(std::min(alpha.y / along, 1.0), kRatios);
    const Cell wide(std::min(along / alpha.x, 1.0), kRatios), size(std::pow(alpha.x, 0.75), kAlphas);
    glm::dvec2 sum(0.0);
    for (std::size_t corner = 0; corner < 16; ++corner) {
        const std::size_t i = corner & 1U, j = corner >> 1U & 1U, k = corner >> 2U & 1U, l = corner >> 3U;
        const auto part = [](const Cell& cell, std::size_t upper) { return upper == 0 ? 1.0 - cell.weight : cell.weight; };
        sum += part(seen, i) * part(narrow, j) * part(wide, k) * part(size, l) *
               entries[indexOf(seen.first + i, narrow.first + j, wide.first + k, size.first + l)];
    }
    return {sum.x, sum.x * fifthPower(1.0 - std::min(sum.y * stretched, 1.0))};
}

// l and b (scene_types.h): of what kernels look up, so that what the microfacets lose in one direction comes back in all.
glm::dvec2 averageOverDirections(const std::vector<glm::dvec2>& entries, const GaussRule& cosines, const GaussRule& azimuths, double alphaX,
                                 double ratio)
{
    const glm::dvec2 alpha(alphaX, ratio * alphaX);
    glm::dvec2 sum(0.0);
    for (std::size_t i = 0; i < cosines.nodes.size(); ++i) {
        const double x = 0.5 * (cosines.nodes[i] + 1.0), z = x * x * x * x, sine = std::sqrt((1.0 - z) * (1.0 + z));
        for (std::size_t j = 0; j < azimuths.nodes.size(); ++j) {
            const double phi = 0.25 * pi * (azimuths.nodes[j] + 1.0);
            const glm::dvec2 albedo = lookUp(entries, {sine * std::cos(phi), sine * std::sin(phi), z}, alpha);
            // 2 z dz over [0, 1] and the mean over phi
            sum += glm::dvec2(1.0 - albedo.x, albedo.y) * (4.0 * x * x * x * z * cosines.weights[i] * 0.5 * azimuths.weights[j]);
        }
    }
    return {rounded(sum.x / alphaX), rounded(sum.y)};
}

std::vector<glm::dvec2> makeAverages(const std::vector<glm::dvec2>& entries)
{
    const GaussRule cosines(24), azimuths(10);
    std::vector<glm::dvec2> averages(std::size_t{kAnisotropicAverageRatios} * kAnisotropicAverageAlphas);
    parallelFor(averages.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
        const double ratio = std::max(share(i % kAnisotropicAverageRatios, kAnisotropicAverageRatios), kMinRatio);
        const double root = share(i / kAnisotropicAverageRatios, kAnisotropicAverageAlphas);
        averages[i] = averageOverDirections(entries, cosines, azimuths, std::max(root * root, kMinAnisotropicAlpha), ratio);
    });
    return averages;
}

}  // namespace

std::vector<uvec4> makeAnisotropicAlbedoTable()
{
    const std::vector<glm::dvec2> entries = makeEntries();
    std::vector<uvec4> table;
    pushTexels(table, entries);
    pushTexels(table, makeAverages(entries));
    return table;
}

}  // namespace glim
