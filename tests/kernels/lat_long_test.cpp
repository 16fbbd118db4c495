#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim::lat_long_test {

constexpr double kPi = std::numbers::pi;

struct Case {
    vec3 w;
    float u, q;
    std::uint32_t lower;
};

struct Result {
    vec2 at;
    vec3 direction;
    float angle;
};

std::vector<Result> mapped(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::lat_long_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// The middle is -z, +x is to its right, the first row is +y.
glm::dvec2 onTheMap(const glm::dvec3& w)
{
    return {0.5 + std::atan2(w.x, -w.z) / (2.0 * kPi), std::atan2(std::hypot(w.x, w.z), w.y) / kPi};
}

// Across the seam u = 0 is u = 1.
double distanceAcross(double a, double b) { return std::min(std::abs(a - b), 1.0 - std::abs(a - b)); }

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

std::vector<Case> randomCases()
{
    Random random(8);
    std::vector<Case> cases(200000);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        glm::dvec3 w = random.direction();
        if (i % 4 == 0) {  // near a pole
            const double angle = 2.0 * kPi * random.uniform(), sine = random.logUniform(1e-12, 0.1);
            w = {sine * std::cos(angle), (i % 8 == 0 ? 1.0 : -1.0) * std::sqrt(1.0 - sine * sine), sine * std::sin(angle)};
        } else if (i % 4 == 1) {  // near the seam
            w = glm::normalize(glm::dvec3(random.uniform(-1e-6, 1e-6), random.uniform(-1.0, 1.0), 1.0));
        }
        cases[i] = {vec3(w), random.unitFloat(), static_cast<float>(random.logUniform(1e-14, 0.5)), i % 2 == 0 ? 1U : 0U};
    }
    return cases;
}

TEST(LatLongTest, H15DirectionsAsInDouble)
{
    const std::vector<Case> cases = randomCases();
    const std::vector<Result> results = mapped(cases);
    double worst = 0.0, worstBack = 0.0, naive = 0.0, worstAngle = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const glm::dvec3 w(cases[i].w);
        const glm::dvec2 expected = onTheMap(w), at(results[i].at);
        worst = std::max({worst, distanceAcross(at.x, expected.x), std::abs(at.y - expected.y)});
        naive = std::max(naive, std::abs(static_cast<double>(std::acos(cases[i].w.y)) / kPi - expected.y));
        worstAngle = std::max(worstAngle, std::abs(static_cast<double>(results[i].angle) - std::atan2(w.y, w.x)));
        const double u = static_cast<double>(cases[i].u), q = static_cast<double>(cases[i].q);
        const double polar = 2.0 * std::asin(std::sqrt(q)), theta = cases[i].lower != 0 ? kPi - polar : polar, phi = 2.0 * kPi * (u - 0.5);
        const glm::dvec3 direction(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
        worstBack = std::max(worstBack, angleBetween(glm::dvec3(results[i].direction), direction));
    }
    // Of the map: 1.1e-7 of arcTangent over pi, and rounding.
    EXPECT_LE(worst, 1.5e-7);
    EXPECT_LE(worstAngle, 5e-7);
    EXPECT_LE(worstBack, 5e-7);
    printHardCase("H15", "places of directions on a map, also near the poles", static_cast<double>(cases.size()),
                  "within " + figure(worst) + " of the map; back within " + figure(worstBack) + " rad",
                  "an arc cosine: off by " + figure(naive) + " of its height");
}

TEST(LatLongTest, PolesSeamAndAxes)
{
    const std::pair<vec3, vec2> known[] = {{{0, 0, -1}, {0.5F, 0.5F}},       {{1, 0, 0}, {0.75F, 0.5F}}, {{-1, 0, 0}, {0.25F, 0.5F}},
                                           {{0, 1, 0}, {0.5F, 0.0F}},        {{0, -1, 0}, {0.5F, 1.0F}}, {{0.0F, 0, 1}, {1.0F, 0.5F}},
                                           {{-0.0F, 1, -0.0F}, {0.5F, 0.0F}}};
    std::vector<Case> cases;
    for (const auto& [w, at] : known) {
        cases.push_back({w, 0.0F, 0.0F, 0});
    }
    const std::vector<Result> results = mapped(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        EXPECT_LE(distanceAcross(static_cast<double>(results[i].at.x), static_cast<double>(known[i].second.x)), 1e-7) << i;
        EXPECT_NEAR(results[i].at.y, known[i].second.y, 1e-7) << i;
    }
}

}  // namespace glim::lat_long_test
