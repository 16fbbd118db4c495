#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::bsdf_lobes_test {

struct Case {
    vec3 albedo;
    float cosine;
    vec2 u;
    float uLobe;
    vec3 n, woAt, mirrored;
    float schlick, ior;
    vec2 reflected;
};

// Mean of the two polarisations by Snell's and Fresnel's laws; `eta`: index beyond over index before.
double reflectance(double cosine, double eta)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine)) / eta;
    if (sine >= 1.0) {
        return 1.0;
    }
    const double beyond = std::sqrt((1.0 - sine) * (1.0 + sine));
    const double s = (cosine - eta * beyond) / (cosine + eta * beyond), p = (eta * cosine - beyond) / (eta * cosine + beyond);
    return 0.5 * (s * s + p * p);
}

glm::dvec3 upwards(glm::dvec3 d, const glm::dvec3& n) { return glm::dot(d, n) < 0.0 ? -d : d; }

Case makeCase(Random& random)
{
    Case c{};
    c.albedo = vec3(random.uniform(), random.uniform(), random.uniform());
    c.cosine = static_cast<float>(random.direction().z);
    c.u = {random.unitFloat(), random.unitFloat()};
    c.uLobe = random.unitFloat();
    c.n = random.direction();
    const glm::dvec3 n = glm::normalize(glm::dvec3(c.n));
    c.woAt = upwards(random.direction(), n);
    const glm::dvec3 wo(c.woAt);
    const double cosine = std::clamp(glm::dot(wo, n), 0.0, 1.0);
    c.mirrored = 2.0 * cosine * n - wo;
    c.schlick = static_cast<float>(std::pow(1.0 - cosine, 5.0));
    c.ior = random.below(4) == 0 ? 1.5F : static_cast<float>(random.uniform(1.05, 2.5));
    const double ior = static_cast<double>(c.ior);
    c.reflected = {reflectance(cosine, ior), reflectance(cosine, 1.0 / ior)};
    return c;
}

TEST(BsdfLobesTest, WeightsAreWhatTheyStandFor)
{
    for (int round = 0; round < testRounds(); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 7 + 21);
        std::vector<Case> cases(200000);
        std::generate(cases.begin(), cases.end(), [&random] { return makeCase(random); });
        const float edges[] = {0.0F, 0x1p-24F, 0.5F, 1.0F - 0x1p-24F};  // H18
        for (std::size_t i = 0; i < 16; ++i) {
            cases[i].u = {edges[i % 4], edges[i / 4]};
        }
        KernelTest(test_kernels::bsdf_lobes_test).cases(cases).run();
    }
}

// T8: the cosine-averaged reflectance of an interface of index 1.5, 0.09178 from outside and 1 - (1 - 0.09178) / 1.5^2 from
// inside; here by the midpoint rule.
TEST(BsdfLobesTest, GlassReflectsItsShare)
{
    constexpr int kSteps = 1000000;
    double outside = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double cosine = (i + 0.5) / kSteps;
        outside += 2.0 * cosine * reflectance(cosine, 1.5) / kSteps;
    }
    EXPECT_NEAR(outside, 0.09178, 5e-6);
    for (int round = 0; round < testRounds(); ++round) {
        KernelTest test(test_kernels::dielectric_test);
        test.parameters().seed = static_cast<std::uint32_t>(round) + 1;
        test.threads(1 << 20).resultsOf<uvec2>(1 << 20).run();
        std::vector<double> fromOutside, fromInside;
        for (const uvec2& reflects : test.results<uvec2>()) {
            fromOutside.push_back(reflects.x);
            fromInside.push_back(reflects.y);
        }
        const std::size_t tests = 2 * static_cast<std::size_t>(testRounds());
        expectSampleMean("reflected from outside", fromOutside, outside, tests);
        expectSampleMean("reflected from inside", fromInside, 1.0 - (1.0 - outside) / 2.25, tests);
    }
}

}  // namespace glim::bsdf_lobes_test
