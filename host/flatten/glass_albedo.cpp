#include "host/flatten/albedo_table.hpp"

#include "host/bvh/parallel_for.hpp"
#include "host/flatten/albedo_parts.hpp"
#include "shaders/shared/microfacets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <thread>

namespace glim {
namespace {

using std::numbers::pi;

constexpr std::size_t kIndices = kGlassDenser + kGlassThinner;

// Two numbers of Fibonacci, of a lattice in the unit square.
constexpr std::size_t kGlassNodes = 987, kStep = 610;

// In the place of 0 at the ends of the table's axes: what the functions tend to.
constexpr double kMinGlassCosine = 1e-6, kMinGlassAlpha = 1e-4;

double shareOfSteps(std::size_t i, std::size_t count) { return static_cast<double>(i) / static_cast<double>(count - 1); }

// An interface between two media.
struct Interface {
    double eta, f0;  // index beyond over that on the side of v; reflectance along the normal
};

Interface interfaceAt(std::size_t i)
{
    const bool denser = i < kGlassDenser;
    const double root = std::lerp(static_cast<double>(kMinGlassRoot), static_cast<double>(kMaxGlassRoot),
                                  denser ? shareOfSteps(i, kGlassDenser) : shareOfSteps(i - kGlassDenser, kGlassThinner));
    const double r = std::pow(root, 4.0) * (denser ? 1.0 : -1.0);
    return {(1.0 + r) / (1.0 - r), r * r};
}

// G2 / G1(v) of a direction at this cosine on either side. `length`: v's stretchedLength.
double passedMasking(double v, double length, double cosine, double alpha)
{
    return (v + length) * cosine / (cosine * length + v * std::sqrt(alpha * alpha * (1.0 - cosine * cosine) + cosine * cosine));
}

// Over normals that are visible from v (Dupuy and Benyoub 2023, as sampleVisibleNormal): the means of G2 / G1 of what they reflect and
// refract. By a lattice over the height on the spherical cap and half of the azimuths: it has many heights for v along the normal, where
// the azimuth does not matter and total reflection begins at one height. Off by 1.6e-3 at most, 2e-4 in the mean.
std::array<glm::dvec3, kIndices> integrateGlassAlbedo(const std::array<Interface, kIndices>& interfaces, double cosine, double alpha)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine)), length = stretchedLength({sine, 0.0, cosine}, {alpha, alpha});
    const glm::dvec3 w(alpha * sine / length, 0.0, cosine / length);
    constexpr double weight = 1.0 / kGlassNodes;
    std::array<glm::dvec3, kIndices> sums{};
    for (std::size_t node = 0; node < kGlassNodes; ++node) {
        const double phi = pi * static_cast<double>(node * kStep % kGlassNodes) / kGlassNodes;
        const double q = (static_cast<double>(node) + 0.5) / kGlassNodes * (1.0 + w.z), r = std::sqrt(q * (2.0 - q));
        const glm::dvec3 c(r * std::cos(phi) + w.x, r * std::sin(phi), 1.0 - q + w.z);
        const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * c.x, alpha * c.y, c.z));
        const double vh = std::min(sine * h.x + cosine * h.z, 1.0), reflectedZ = 2.0 * vh * h.z - cosine;
        if (!(vh > 0.0)) {
            continue;
        }
        const double reflected = reflectedZ > 0.0 ? passedMasking(cosine, length, std::min(reflectedZ, 1.0), alpha) : 0.0;
        for (std::size_t i = 0; i < kIndices; ++i) {
            const auto [eta, f0] = interfaces[i];
            const double refracted2 = 1.0 - (1.0 - vh * vh) / (eta * eta);
            if (!(refracted2 > 0.0)) {
                sums[i].x += weight * reflected;  // all of it
                continue;
            }
            const double refractedH = std::sqrt(refracted2), refractedZ = (refractedH - vh / eta) * h.z + cosine / eta;
            const double refracted = refractedZ > 0.0 ? passedMasking(cosine, length, std::min(refractedZ, 1.0), alpha) : 0.0;
            const double s = (vh - eta * refractedH) / (vh + eta * refractedH), p = (eta * vh - refractedH) / (eta * vh + refractedH);
            const double schlick = (0.5 * (s * s + p * p) - f0) / (1.0 - f0), more = weight * (reflected - refracted);
            sums[i] += glm::dvec3(weight * refracted, (1.0 - schlick) * more, schlick * more);
        }
    }
    return sums;
}

// The share of lost light from the side of the smaller index that leaves on that side. Fitted to random walks on Smith's microsurface
// (Heitz et al., "Multiple-Scattering Microfacet BSDFs with the Smith Model", 2016), by what they reflect more than single scattering; for
// the other side it gives what the walks give there, too.
double reflectedShare(double alpha, double f0)
{
    return std::min(0.345 * std::pow(alpha, -0.25) * std::pow(f0, 0.9 * std::sqrt(alpha)), 1.0);
}

// 2 int f(cosine) cosine dcosine of the function that is linear between the fourth roots of cosines (averageOverCosines).
std::array<double, kGlassCosines> makeCosineWeights()
{
    std::array<double, kGlassCosines> weights{};
    for (std::size_t i = 0; i + 1 < kGlassCosines; ++i) {
        const double x0 = shareOfSteps(i, kGlassCosines), x1 = shareOfSteps(i + 1, kGlassCosines);
        const double m8 = std::pow(x1, 8.0) - std::pow(x0, 8.0), m9 = 8.0 / 9.0 * (std::pow(x1, 9.0) - std::pow(x0, 9.0));
        weights[i] += (x1 * m8 - m9) / (x1 - x0);
        weights[i + 1] += (m9 - x0 * m8) / (x1 - x0);
    }
    return weights;
}

uvec4 roundedTexel(const glm::dvec3& parts, double fourth)
{
    return texelOf({rounded(parts.x), rounded(parts.y)}, {rounded(parts.z), rounded(fourth)});
}

}  // namespace

std::vector<uvec4> makeGlassAlbedoTable()
{
    std::array<Interface, kIndices> interfaces{};
    for (std::size_t i = 0; i < kIndices; ++i) {
        interfaces[i] = interfaceAt(i);
    }
    const std::array<double, kGlassCosines> cosineWeights = makeCosineWeights();
    std::vector<uvec4> table(kGlassAlbedos + std::size_t{kGlassAlphas} * kIndices);
    parallelFor(kGlassAlphas, std::thread::hardware_concurrency(), [&](std::size_t row) {
        const double alpha = std::max(std::pow(shareOfSteps(row, kGlassAlphas), 2.0), kMinGlassAlpha);
        std::array<glm::dvec3, kIndices> averages{};
        for (std::size_t column = 0; column < kGlassCosines; ++column) {
            const double cosine = std::max(std::pow(shareOfSteps(column, kGlassCosines), 4.0), kMinGlassCosine);
            const auto albedos = integrateGlassAlbedo(interfaces, cosine, alpha);
            for (std::size_t i = 0; i < kIndices; ++i) {
                table[column + kGlassCosines * (row + kGlassAlphas * i)] = roundedTexel(albedos[i], 0.0);
                averages[i] += cosineWeights[column] * albedos[i];
            }
        }
        for (std::size_t i = 0; i < kIndices; ++i) {
            table[kGlassAlbedos + row + kGlassAlphas * i] = roundedTexel(averages[i], reflectedShare(alpha, interfaces[i].f0));
        }
    });
    return table;
}

}  // namespace glim
