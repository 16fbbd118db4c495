// H41: the driver's functions are as exact as Vulkan promises, which bounds what the tests beside this one grant.
#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::driver_precision_test {

struct Case {
    float x, y, z, w;
};

struct Result {
    float sine, cosine, root, quotient, inverse, arctangent, power, polar, arccosine;
};

struct Errors {
    double sine, cosine, polar, arccosine;              // absolute
    double root, quotient, inverse, arctangent, power;  // ulp: relative in units of 2^-23
};

double ulps(float value, double truth)
{
    return truth == 0.0 ? std::abs(static_cast<double>(value)) : std::abs(static_cast<double>(value) / truth - 1.0) * 0x1p23;
}

void raise(double& worst, double error) { worst = std::max(worst, error); }

void count(Errors& worst, const Case& c, const Result& r)
{
    const double x = static_cast<double>(c.x), y = static_cast<double>(c.y), z = static_cast<double>(c.z);
    raise(worst.sine, std::abs(static_cast<double>(r.sine) - std::sin(x)));
    raise(worst.cosine, std::abs(static_cast<double>(r.cosine) - std::cos(x)));
    raise(worst.root, ulps(r.root, std::sqrt(y)));
    raise(worst.quotient, ulps(r.quotient, x / z));
    raise(worst.inverse, ulps(r.inverse, 1.0 / std::sqrt(y)));
    raise(worst.arctangent, ulps(r.arctangent, std::atan2(x, z)));
    const double angle = std::acos(static_cast<double>(c.w));
    raise(worst.polar, std::abs(static_cast<double>(r.polar) - angle));
    raise(worst.arccosine, std::abs(static_cast<double>(r.arccosine) - angle));
    raise(worst.power, ulps(r.power, std::exp2(x)) / (3.0 + 2.0 * std::abs(x)));
}

TEST(DriverPrecisionTest, H41PrecisionIsWhatVulkanRequires)
{
    if (testDevice().arithmetic().adverse) {
        GTEST_SKIP() << "adverse arithmetic adds as much to the driver's own errors as Vulkan allows in all";
    }
    Random random(41);
    std::vector<Case> cases(hardTrials(200000));
    for (Case& c : cases) {
        c.x = static_cast<float>(random.uniform(-std::numbers::pi, std::numbers::pi));
        c.y = static_cast<float>(random.logUniform(1e-30, 1e30));
        c.z = static_cast<float>(random.logUniform(1e-6, 1e6) * (random.below(2) == 0 ? 1.0 : -1.0));
        c.w = c.x / std::numbers::pi_v<float>;
    }
    KernelTest test(test_kernels::driver_precision_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    Errors worst{};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        count(worst, cases[i], results[i]);
    }
    printHardCase("H41", "the driver's functions", static_cast<double>(cases.size()),
                  "sin, cos within " + figure(std::max(worst.sine, worst.cosine)) + "; ulp: / " + figure(worst.quotient) + ", sqrt " +
                      figure(worst.root) + ", inversesqrt " + figure(worst.inverse) + ", atan " + figure(worst.arctangent) + ", exp2 " +
                      figure(worst.power) + " of what is allowed; the angle to a pole by atan within " + figure(worst.polar),
                  "by acos within " + figure(worst.arccosine));
    // Vulkan, "Precision and Operation of SPIR-V Instructions"; sqrt inherits from 1 / inversesqrt.
    EXPECT_LE(std::max(worst.sine, worst.cosine), 0x1p-11);
    EXPECT_LE(worst.quotient, 2.5);
    EXPECT_LE(worst.inverse, 2.0);
    EXPECT_LE(worst.root, 4.5);
    EXPECT_LE(worst.arctangent, 4096.0);
    EXPECT_LE(worst.power, 1.0);
}

}  // namespace glim::driver_precision_test
