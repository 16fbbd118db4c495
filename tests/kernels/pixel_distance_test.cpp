// How alike the denoiser finds two pixels: against the paper's formula in double precision, and on average over noise.
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace glim::pixel_distance_test {

struct Case {
    vec3 meanA, varianceA, meanB, varianceB;
    float distance, tolerance;
};

// Rousselle, Knaus, Zwicker 2012, equation 6, with k = .5 and their epsilon of 1e-10. The tolerance is that of the difference of two
// floats, relative to the noise: 2^-22 of each term.
void expectTheFormula(Case& c)
{
    double distance = 0.0, tolerance = 1e-6;
    for (int k = 0; k < 3; ++k) {
        const double a = static_cast<double>(c.meanA[k]), b = static_cast<double>(c.meanB[k]);
        const double va = static_cast<double>(c.varianceA[k]), vb = static_cast<double>(c.varianceB[k]);
        const double unit = 1e-10 + 0.25 * (va + vb);
        distance += ((a - b) * (a - b) - va - std::min(va, vb)) / unit / 3.0;
        tolerance += 0x1p-22 * ((a - b) * (a - b) + va + vb) / unit;
    }
    c.distance = static_cast<float>(distance);
    c.tolerance = static_cast<float>(tolerance);
}

std::vector<glm::vec2> measure(std::vector<Case> cases)
{
    for (Case& c : cases) {
        expectTheFormula(c);
    }
    KernelTest test(test_kernels::pixel_distance_test);
    test.cases(cases).resultsOf<glm::vec2>(cases.size()).run();
    return test.results<glm::vec2>();
}

TEST(PixelDistanceTest, IsTheFormulaOfThePaper)
{
    std::mt19937 random(5);
    std::lognormal_distribution<float> value(-1.0F, 3.0F);
    const auto any = [&] { return vec3(value(random), value(random), value(random)); };
    std::vector<Case> cases(20000);
    for (Case& c : cases) {
        c = {any(), 0.01F * any(), any(), 0.01F * any(), 0.0F, 0.0F};
    }
    cases.push_back({vec3(0.0F), vec3(0.0F), vec3(0.0F), vec3(0.0F), 0.0F, 0.0F});
    cases.push_back({vec3(1.0F), vec3(0.0F), vec3(2.0F), vec3(0.0F), 0.0F, 0.0F});
    const std::vector<glm::vec2> results = measure(cases);
    EXPECT_EQ(results[20000], glm::vec2(0.0F, 1.0F)) << "constant and equal";
    EXPECT_EQ(results[20001].y, 0.0F) << "constant and unlike";
}

// Of one radiance and a noise of 1 and s, the mean is 4 (s - min(1, s)) / (1 + s). The distance of normal noise has the variance
// 2 (4 (1 + s) / (1 + s))^2 = 32 in one channel and a third of it for three.
TEST(PixelDistanceTest, OnlyMoreNoiseThanItsOwnMakesAPixelUnlike)
{
    std::mt19937 random(6);
    std::normal_distribution<float> normal;
    const auto noise = [&](float deviation) { return deviation * vec3(normal(random), normal(random), normal(random)); };
    for (const float s : {0.25F, 1.0F, 4.0F}) {
        std::vector<Case> cases(100000);
        for (Case& c : cases) {
            c = {10.0F + noise(1.0F), vec3(1.0F), 10.0F + noise(std::sqrt(s)), vec3(s), 0.0F, 0.0F};
        }
        double sum = 0.0;
        for (const glm::vec2& result : measure(cases)) {
            sum += static_cast<double>(result.x);
        }
        const double expected = 4.0 * static_cast<double>(s - std::min(1.0F, s)) / static_cast<double>(1.0F + s);
        const double standardError = std::sqrt(32.0 / 3.0 / static_cast<double>(cases.size()));
        EXPECT_NEAR(sum / static_cast<double>(cases.size()), expected, 4.5 * standardError) << s;
    }
}

}  // namespace glim::pixel_distance_test
