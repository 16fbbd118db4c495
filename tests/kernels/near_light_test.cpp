// H13: a square light of 1 m, parallel to the receiver, at smaller and smaller distances. Measures the deviation of single samples relative
// to the mean.
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/irradiance.hpp"
#include "tests/support/irradiance_formulas.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::near_light_test {

constexpr double kPerThread = 64.0;  // samples behind one of the values that the standard error is made of

struct Near {
    double deviation;  // relative
    double trials;
};

Near measure(float height)
{
    const std::array<glm::vec3, 4> corners = {
        glm::vec3(-0.5F, height, -0.5F), {0.5F, height, -0.5F}, {0.5F, height, 0.5F}, {-0.5F, height, 0.5F}};
    SceneBuilder builder;
    builder.quad(corners, builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
    const double truth = computePolygonIrradiance(std::vector<glm::dvec3>(corners.begin(), corners.end()), {0, 1, 0});
    const auto estimate = expectIrradiance("T12 near square", builder.scene(), {{glm::vec3(0.0F), {0, 1, 0}, truth}})[0];
    const double trials = static_cast<double>(hardTrials(2048 * 64));
    return {estimate.standardError * std::sqrt(trials) / truth, trials};
}

TEST(NearLightTest, H13DeviationIsThatOfTheCosine)
{
    struct Height {
        float height;
        double deviation, byArea;
    };
    for (const Height& each : {Height{1.0F, 0.04, 0.17}, {0.1F, 0.40, 3.2}, {0.01F, 0.55, 32.0}, {1e-3F, 0.61, 367.0}}) {
        const Near near = measure(each.height);
        printHardCase("H13", "square of 1 m at " + figure(static_cast<double>(each.height)), near.trials,
                      "mean right, deviation " + figure(near.deviation), "by area: " + figure(each.byArea));
        EXPECT_NEAR(near.deviation, each.deviation, 0.1 * each.deviation);
    }
}

}  // namespace glim::near_light_test
