#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace glim::fresnel_test {

struct Case {
    float cosine, eta;
    float reflected, tolerance;
    float beyond;
    vec3 color, schlick;
    vec3 wo, n, mirrored, passed;
    float passedTolerance;
};

// Fresnel's sine and tangent laws (1823), the mean of both polarisations.
double reflectance(double cosine, double eta)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    if (sine >= eta) {
        return 1.0;
    }
    if (sine < 1e-7) {
        return std::pow((eta - 1.0) / (eta + 1.0), 2.0);
    }
    const double i = std::atan2(sine, cosine), t = std::asin(sine / eta);
    const double s = std::sin(i - t) / std::sin(i + t), p = std::tan(i - t) / std::tan(i + t);
    return 0.5 * (s * s + p * p);
}

// The same from k, the square of the cosine beyond, to see how an error of k counts.
double reflectanceOf(double c, double eta, double k)
{
    const double t = std::sqrt(std::max(0.0, k));
    const double p = (eta * c - t) / (eta * c + t), s = (c - eta * t) / (c + eta * t);
    return 0.5 * (s * s + p * p);
}

void setReflectance(Case& c)
{
    const double cosine = static_cast<double>(c.cosine), eta = static_cast<double>(c.eta);
    const double sine2 = (1.0 - cosine) * (1.0 + cosine), k = 1.0 - sine2 / (eta * eta);
    // Rounding of k: three operations on its two terms, their sum, and a quotient of 2.5 ulp.
    const double error = 0x1p-24 * (4.0 * (std::abs(eta * eta - 1.0) + cosine * cosine) / (eta * eta) + 6.0 * std::abs(k));
    c.reflected = static_cast<float>(reflectance(cosine, eta));
    const double span = std::max(std::abs(reflectanceOf(cosine, eta, k + error) - reflectanceOf(cosine, eta, k)),
                                 std::abs(reflectanceOf(cosine, eta, k - error) - reflectanceOf(cosine, eta, k)));
    c.tolerance = k < -error ? 0.0F : static_cast<float>(eta > 0.6 ? std::min(2e-3, span + 2e-6) : span + 2e-6);
    c.beyond = k > 0.05 && cosine > 0.2 && eta > 0.5 && eta < 2.0 ? static_cast<float>(std::sqrt(k)) : -1.0F;
}

void setDirections(Case& c, Random& random)
{
    const glm::dvec3 n = random.direction();
    glm::dvec3 wo = random.direction();
    wo = glm::dot(wo, n) < 0.0 ? -wo : wo;
    c.n = n;
    c.wo = wo;
    const glm::dvec3 along(c.n), from(c.wo);
    const double cosine = glm::dot(from, along) / glm::length(along), eta = static_cast<double>(c.eta);
    const glm::dvec3 across = from - cosine * along;
    c.mirrored = cosine * along - across;
    // Snell: the tangential part shrinks by eta, the normal part makes the length 1.
    const double k = 1.0 - glm::dot(across, across) / (eta * eta);
    const double error = 4e-7 * (1.0 + cosine) * (1.0 + 1.0 / (eta * eta));  // of k, rounding of unit vectors included
    c.passed = -across / eta - std::sqrt(std::max(0.0, k)) * along;
    c.passedTolerance = k > 2.0 * error ? static_cast<float>(2e-6 * (1.0 + 1.0 / eta) + error / std::sqrt(k)) : -1.0F;
}

Case makeCase(Random& random, int kind)
{
    Case c{};
    c.eta = static_cast<float>(random.logUniform(1.0 / 3.0, 3.0));
    c.cosine = random.unitFloat();
    const double eta = static_cast<double>(c.eta);
    if (kind == 1 && eta < 1.0) {  // near the critical angle, on either side
        c.cosine = static_cast<float>(
            std::sqrt(std::max(0.0, 1.0 - eta * eta + random.logUniform(1e-7, 1e-2) * (random.below(2) == 0 ? 1.0 : -1.0))));
    } else if (kind == 2) {  // nearly no interface
        c.eta = static_cast<float>(1.0 + random.logUniform(1e-6, 1e-2) * (random.below(2) == 0 ? 1.0 : -1.0));
    } else if (kind == 3) {
        c.cosine = random.below(2) == 0 ? 0.0F : static_cast<float>(random.logUniform(1e-8, 1e-2));
    } else if (kind == 4) {
        c.cosine = 1.0F - static_cast<float>(random.below(16)) * 0x1p-24F;
    }
    setReflectance(c);
    setDirections(c, random);
    const glm::dvec3 color(random.uniform(), random.uniform(), random.uniform());
    c.color = color;
    c.schlick = color + (1.0 - color) * std::pow(1.0 - static_cast<double>(c.cosine), 5.0);
    return c;
}

// As it is often written: no clamps, and the sine from 1 - c^2 rounded before the difference.
float naiveFresnel(float c, float eta)
{
    const float sine2 = (1.0F - c * c) / (eta * eta), t = std::sqrt(1.0F - sine2);
    const float p = (eta * c - t) / (eta * c + t), s = (c - eta * t) / (c + eta * t);
    return 0.5F * (s * s + p * p);
}

// Near the critical angle the reflectance goes as the square root of k, so the tolerance is what k's rounding does to it;
// H21's 2e-3 caps it for indices up to 1 / 0.6 (at index 3 the last ulp of k alone is worth 5e-3).
TEST(FresnelTest, H21AgreesWithTheSineAndTangentLaws)
{
    constexpr int kCases = 800000;
    std::size_t wrong = 0;
    for (int round = 0; round < hardRounds(kCases); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 7 + 14);
        std::vector<Case> cases;
        float largest = 0.0F, ordinary = 0.0F;
        for (int i = 0; i < kCases; ++i) {
            cases.push_back(makeCase(random, i % 8));
            const Case& c = cases.back();
            const float k = 1.0F - (1.0F - c.cosine) * (1.0F + c.cosine) / (c.eta * c.eta);
            largest = std::max(largest, c.tolerance);
            wrong += std::abs(naiveFresnel(c.cosine, c.eta) - c.reflected) <= c.tolerance ? 0 : 1;
            ordinary = std::max(ordinary, k > 0.05F ? c.tolerance : 0.0F);
        }
        std::cout << "  tolerance: up to " << largest << ", away from the critical angle " << ordinary << '\n';
        EXPECT_LE(ordinary, 1e-5F);
        KernelTest(test_kernels::fresnel_test).cases(cases).run();
    }
    printHardCase("H21", "indices 1/3 to 3, the critical angle, grazing", 1.0 * kCases * hardRounds(kCases),
                  "within the rounding of the angle", "no clamps: " + std::to_string(wrong) + " wrong or NaN");
}

}  // namespace glim::fresnel_test
