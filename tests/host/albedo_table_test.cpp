#include "host/flatten/albedo_table.hpp"

#include "tests/harness/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;

double fourth(std::size_t i) { return std::pow(static_cast<double>(i) / (kAlbedoSize - 1), 4.0); }

double numberAt(const uvec4& texel, int word) { return static_cast<double>(std::bit_cast<float>(texel[word])); }

// The albedo of the GGX lobe for a reflectance of 1 by sampling: the mean of G2 / G1 over visible normals (Heitz 2018), stratified.
double sampledAlbedo(double cosine, double alpha, Random& random)
{
    constexpr int kSide = 300;
    const glm::dvec3 v(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    const auto lambda = [alpha](double z) { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - z * z) / (z * z)) - 1.0); };
    const glm::dvec3 w = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
    double sum = 0.0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const double phi = 2.0 * kPi * (i % kSide + random.uniform()) / kSide, q = (i / kSide + random.uniform()) / kSide * (1.0 + w.z);
        const double sine = std::sqrt(q * (2.0 - q));
        const glm::dvec3 c = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), 1.0 - q) + w;
        const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * c.x, alpha * c.y, c.z));
        const double lz = 2.0 * glm::dot(v, h) * h.z - v.z;
        sum += lz > 0.0 ? (1.0 + lambda(v.z)) / (1.0 + lambda(v.z) + lambda(lz)) : 0.0;
    }
    return sum / (kSide * kSide);
}

TEST(AlbedoTable, HoldsTheAlbedosOfTheLobe)
{
    const std::vector<uvec4> table = makeAlbedoTable();
    ASSERT_EQ(table.size(), (kAlbedoSize + 1) * kAlbedoSize);
    Random random(7);
    for (const std::size_t row : {20U, 32U, 48U, 63U}) {
        for (const std::size_t column : {20U, 32U, 44U, 63U}) {
            const uvec4& texel = table[row * kAlbedoSize + column];
            // Stratified samples of a function of bounded variation: 90,000 of them are within 2e-3.
            EXPECT_NEAR(numberAt(texel, 0) + numberAt(texel, 1), sampledAlbedo(fourth(column), fourth(row), random), 2e-3)
                << row << ' ' << column;
        }
    }
}

TEST(AlbedoTable, ASmoothSurfaceFollowsSchlick)
{
    const std::vector<uvec4> table = makeAlbedoTable();
    for (std::size_t column = 1; column < kAlbedoSize; ++column) {
        const double schlick = std::pow(1.0 - fourth(column), 5.0);
        EXPECT_NEAR(numberAt(table[column], 0), 1.0 - schlick, 3e-7);
        EXPECT_NEAR(numberAt(table[column], 1), schlick, 3e-7);
    }
    const uvec4& average = table[kAlbedoSize * kAlbedoSize];
    EXPECT_NEAR(numberAt(average, 0), 20.0 / 21.0, 2e-4) << "of the interpolated function";
    EXPECT_NEAR(numberAt(average, 1), 1.0 / 21.0, 2e-4);
}

TEST(AlbedoTable, NeighboursAreInTheSameTexel)
{
    const std::vector<uvec4> table = makeAlbedoTable();
    for (std::size_t i = 0; i + 1 < table.size(); ++i) {
        if (i % kAlbedoSize != kAlbedoSize - 1) {
            EXPECT_EQ(table[i][2], table[i + 1][0]);
            EXPECT_EQ(table[i][3], table[i + 1][1]);
        }
    }
}

// The albedo of a refracting interface by sampling as above: of visible normals, each reflects its Fresnel share and refracts the rest.
double sampledGlassAlbedo(double cosine, double alpha, double eta, Random& random)
{
    constexpr int kSide = 300;
    const glm::dvec3 v(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    const auto lambda = [alpha](double z) { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - z * z) / (z * z)) - 1.0); };
    const auto passed = [&](double z) { return z > 0.0 ? (1.0 + lambda(cosine)) / (1.0 + lambda(cosine) + lambda(z)) : 0.0; };
    const glm::dvec3 w = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
    double sum = 0.0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const double phi = 2.0 * kPi * (i % kSide + random.uniform()) / kSide, q = (i / kSide + random.uniform()) / kSide * (1.0 + w.z);
        const double sine = std::sqrt(q * (2.0 - q));
        const glm::dvec3 c = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), 1.0 - q) + w;
        const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * c.x, alpha * c.y, c.z)), l = glm::refract(-v, h, 1.0 / eta);
        const double vh = glm::dot(v, h), lh = -glm::dot(l, h), reflected = passed(2.0 * vh * h.z - cosine);
        const double s = (vh - eta * lh) / (vh + eta * lh), p = (eta * vh - lh) / (eta * vh + lh), f = 0.5 * (s * s + p * p);
        sum += lh > 0.0 ? f * reflected + (1.0 - f) * passed(-l.z) : reflected;
    }
    return sum / (kSide * kSide);
}

TEST(AlbedoTable, HoldsTheAlbedosOfGlass)
{
    const std::vector<uvec4> table = makeGlassAlbedoTable();
    ASSERT_EQ(table.size(), kGlassAlbedos + kGlassAlphas * (kGlassDenser + kGlassThinner));
    Random random(8);
    for (const uint index : {1U, 5U, 8U, 12U, 20U, 30U}) {
        const bool denser = index < kGlassDenser;
        const double step = denser ? index / (kGlassDenser - 1.0) : (index - kGlassDenser) / (kGlassThinner - 1.0);
        const double r = std::pow(std::lerp(static_cast<double>(kMinGlassRoot), static_cast<double>(kMaxGlassRoot), step), 4.0);
        const double eta = denser ? (1.0 + r) / (1.0 - r) : (1.0 - r) / (1.0 + r);
        for (const uint row : {6U, 12U, 23U}) {
            for (const uint column : {12U, 20U, 31U}) {
                const uvec4& texel = table[column + kGlassCosines * (row + kGlassAlphas * index)];
                const double albedo = numberAt(texel, 0) + r * r * numberAt(texel, 1) + numberAt(texel, 2);
                const double cosine = std::pow(column / (kGlassCosines - 1.0), 4.0), alpha = std::pow(row / (kGlassAlphas - 1.0), 2.0);
                // The lattice is off by 1.6e-3 at most, the samples by 2e-3.
                EXPECT_NEAR(albedo, sampledGlassAlbedo(cosine, alpha, eta, random), 4e-3) << index << ' ' << row << ' ' << column;
            }
        }
    }
}

}  // namespace
}  // namespace glim
