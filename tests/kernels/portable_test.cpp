// Powers, exponentials and angles against double, in ulp: half of 2^-23 of the result's power of two.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

namespace glim::portable_test {

struct Case {
    float x, y, exponent;
    vec2 point;
    float angle;
};

struct Result {
    float log2, pow, exp2, exp, atan2;
    vec2 cosSin;
};

// |value - truth| in units of 2^-24 of `scale`.
double halfUlps(float value, double truth, double scale) { return std::abs(static_cast<double>(value) - truth) / (scale * 0x1p-24); }

TEST(PortableTest, ErrorsInUlp)
{
    Random random(8);
    std::vector<Case> cases(400000);
    for (Case& c : cases) {
        c.x = static_cast<float>(random.below(2) == 0 ? random.logUniform(1e-37, 1e37) : random.uniform(0.5, 2.0));
        c.y = static_cast<float>(random.uniform(-4.0, 20.0));
        c.exponent = static_cast<float>(random.uniform(-86.0, 87.0));
    }
    // The ends of the mantissa's range, and 1.
    for (const float x : {0x1.6a09e6p-1F, 0x1.6a09e4p-1F, 0x1.6a09e6p0F, 1.0F, 0x1.fffffep-1F, 0x1.000002p0F, 0x1p-122F}) {
        cases.push_back({x, 3.0F, 0.5F});
    }
    KernelTest test(test_kernels::portable_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    double log2 = 0.0, exp2 = 0.0, exp = 0.0, pow = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const double x = static_cast<double>(cases[i].x), y = static_cast<double>(cases[i].y), e = static_cast<double>(cases[i].exponent);
        const double logarithm = std::log2(x), power = y * logarithm;
        log2 = std::max(log2, halfUlps(results[i].log2, logarithm, 1.0 + std::abs(logarithm)));
        exp2 = std::max(exp2, halfUlps(results[i].exp2, std::exp2(e), std::exp2(e)));
        // Their arguments are rounded, and the errors grow by the derivative.
        exp = std::max(exp, halfUlps(results[i].exp, std::exp(e), std::exp(e) * (1.0 + std::abs(e))));
        if (std::abs(power) < 125.0) {
            const double grown = std::exp2(power) * (1.0 + std::abs(y) * (1.0 + std::abs(logarithm)));
            pow = std::max(pow, halfUlps(results[i].pow, std::exp2(power), grown));
        }
    }
    std::cout << "  errors in units of 2^-24: log2 " << log2 << " of 1 + |log2 x|, exp2 " << exp2 << ", exp " << exp << " of 1 + |x|, pow "
              << pow << " of 1 + |y| (1 + |log2 x|)\n";
    // portable.glsl states 1e-7 and 2e-7.
    EXPECT_LE(log2, 1e-7 * 0x1p24);
    EXPECT_LE(exp2, 2e-7 * 0x1p24);
    EXPECT_LE(exp, 2e-7 * 0x1p24);
    EXPECT_LE(pow, 2e-7 * 0x1p24);
}

TEST(PortableTest, AnglesInUlp)
{
    Random random(9);
    std::vector<Case> cases(400000);
    for (Case& c : cases) {
        const double slope = random.below(2) == 0 ? random.logUniform(1e-12, 1e12) : random.uniform(0.3, 3.0);
        const double size = random.logUniform(1e-12, 1e12);
        c.x = static_cast<float>(size);
        c.point = vec2(random.below(2) == 0 ? size : -size, (random.below(2) == 0 ? size : -size) * slope);
        c.angle = static_cast<float>(random.uniform(-0.5, 0.5) * std::numbers::pi * (random.below(2) == 0 ? 1.0 : random.uniform()));
    }
    // Both sides of the seams at 22.5, 45 and 67.5 degrees, and the ends of the cosine's range.
    for (const float slope :
         {0x1.a8279ap-2F, 0x1.a8279cp-2F, 0x1.a82798p-2F, 1.0F, 0x1.fffffep-1F, 0x1.000002p0F, 2.4142134F, 2.4142137F}) {
        for (const float side : {1.0F, -1.0F}) {
            cases.push_back({1.0F, 1.0F, 0.0F, {side, slope}, side * 1.57079633F});
        }
    }
    KernelTest test(test_kernels::portable_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    double atan2 = 0.0, cosine = 0.0, sine = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const double truth = std::atan2(static_cast<double>(cases[i].point.y), static_cast<double>(cases[i].point.x));
        const double angle = static_cast<double>(cases[i].angle);
        atan2 = std::max(atan2, halfUlps(results[i].atan2, truth, std::abs(truth)));
        cosine = std::max(cosine, halfUlps(results[i].cosSin.x, std::cos(angle), 1.0));
        sine = angle == 0.0 ? sine : std::max(sine, halfUlps(results[i].cosSin.y, std::sin(angle), std::abs(std::sin(angle))));
    }
    std::cout << "  errors in units of 2^-24: atan2 " << atan2 << ", cos " << cosine << " of 1, sin " << sine << '\n';
    // portable.glsl states 2.2e-7 and 1.3e-7.
    EXPECT_LE(atan2, 2.2e-7 * 0x1p24);
    EXPECT_LE(cosine, 1.3e-7 * 0x1p24);
    EXPECT_LE(sine, 1.3e-7 * 0x1p24);
}

}  // namespace glim::portable_test
