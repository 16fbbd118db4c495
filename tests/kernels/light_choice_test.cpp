// Lights are chosen by power, triangles by area, and a sphere is sampled evenly over the cone it fills.
#include "test_kernels.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kSamples = 1U << 18;
constexpr std::size_t kFamily = 8;

struct Result {
    uint light;
    uint primitive;
    vec3 wi;
    uint lit;
};

std::vector<Result> sample(const SceneOnDevice& scene)
{
    KernelTest test = scene.test(test_kernels::light_choice_test);
    test.resultsOf<Result>(kSamples).threads(kSamples).run();
    return test.results<Result>();
}

void expectShares(const std::string& what, const std::vector<double>& counts, std::vector<double> weights)
{
    double sum = 0.0, total = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        total += counts[i];
    }
    for (double& weight : weights) {
        weight *= total / sum;
    }
    expectCounts(what, counts, weights, kFamily);
}

// In watts: radiance * pi * area (twice if double-sided), 4 pi I, the mean cone of a spot, what shines on the disk (and, for an
// environment, the sphere) around the scene's box. The strongest channel counts.
TEST(LightChoiceTest, FollowsPowerAndArea)
{
    SceneBuilder builder;
    const std::vector<vec3> fan = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 0.2F}, {0.9F, 1, 1}, {-1, 1, 1}};
    builder.polygon(fan, builder.lambert(vec3(0.0F), vec3(1.0F, 3.0F, 2.0F)))
        .quad({vec3(-1, -1, -1), {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}}, builder.lambert(vec3(0.0F), vec3(0.5F), true))
        .sphere({0, 0.2F, 0}, 0.5F, builder.lambert(vec3(0.0F), vec3(2.0F)))
        .light({"", PunctualLight::Kind::Point, {0, 0.9F, 0}, {0, 0, -1}, vec3(0.3F, 0.7F, 0.0F), 1.0F, 0.0F})
        .light({"", PunctualLight::Kind::Spot, {0, 0.9F, 0}, {0, -1, 0}, vec3(4.0F), 0.9F, 0.5F})
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0, -1, 0}, vec3(1.5F), 1.0F, 0.0F})
        .environment(vec3(0.2F));
    const SceneOnDevice scene(builder.scene());
    std::vector<double> areas;
    double area = 0.0;
    for (std::size_t i = 2; i < fan.size(); ++i) {
        areas.push_back(0.5 * glm::length(glm::cross(dvec3(fan[i - 1] - fan[0]), dvec3(fan[i] - fan[0]))));
        area += areas.back();
    }
    const double radius2 = 3.0;  // of the sphere around [-1, 1]^3, squared
    const std::vector<double> powers = {3.0 * kPi * area,      2.0 * 0.5 * kPi * 4.0, 2.0 * kPi * 4.0 * kPi * 0.25,   4.0 * kPi * 0.7,
                                        4.0 * 2.0 * kPi * 0.3, 1.5 * kPi * radius2,   0.2 * kPi * 4.0 * kPi * radius2};
    ASSERT_EQ(scene.flat.lights.size(), powers.size());
    std::vector<double> lights(powers.size(), 0.0), triangles(areas.size(), 0.0);
    for (const Result& result : sample(scene)) {
        lights[result.light] += 1.0;
        if (result.light == 0 && result.primitive != kNoPrimitive) {
            triangles[result.primitive] += 1.0;
        }
    }
    expectShares("lights by power", lights, powers);
    expectShares("triangles by area", triangles, areas);
}

// Equal areas of the cone's solid angle: 1 - cos and the azimuth, 16 * 16 cells.
TEST(LightChoiceTest, SpreadsEvenlyOverASpheresCone)
{
    for (const double ratio : {0.9, 0.1, 1e-3}) {
        SceneBuilder builder;
        const double distance = 1.0 / ratio;
        builder.sphere(vec3(dvec3(0.0, 0.0, distance)), 1.0F, builder.lambert(vec3(0.0F), vec3(1.0F)));
        const SceneOnDevice scene(builder.scene());
        const double sin2 = ratio * ratio, whole = sin2 / (1.0 + std::sqrt(1.0 - sin2));
        std::vector<double> counts(256, 0.0);
        for (const Result& result : sample(scene)) {
            const dvec3 wi = glm::normalize(dvec3(result.wi));
            const double planar2 = wi.x * wi.x + wi.y * wi.y;
            const double share = planar2 / (1.0 + std::sqrt(1.0 - planar2)) / whole;
            const double turn = (std::atan2(wi.y, wi.x) + kPi) / (2.0 * kPi);
            const int ring = std::clamp(static_cast<int>(16.0 * share), 0, 15);
            counts[16 * ring + std::clamp(static_cast<int>(16.0 * turn), 0, 15)] += 1.0;
        }
        expectShares("cone of r/d " + std::to_string(ratio), counts, std::vector<double>(256, 1.0));
    }
}

// One light of each kind, a sphere seen from without and one from within; the kernel compares each sample with that of the same
// light if it is certain.
TEST(LightChoiceTest, CertainLightsLackTheirProbability)
{
    SceneBuilder builder;
    builder.quad({vec3(-1, 2, -1), {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, builder.lambert(vec3(0.0F), vec3(1.0F), true))
        .sphere({3, 1, 0}, 0.5F, builder.lambert(vec3(0.0F), vec3(2.0F)))
        .sphere({0, 0, 1}, 5.0F, builder.lambert(vec3(0.0F), vec3(0.1F), true))
        .light({"", PunctualLight::Kind::Point, {0, 0.9F, 0}, {0, 0, -1}, vec3(3.0F, 7.0F, 0.0F), 1.0F, 0.0F})
        .light({"", PunctualLight::Kind::Spot, {0, 0.9F, 0}, {0, -1, 0}, vec3(90.0F), 0.9F, 0.5F})
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0, -1, 0}, vec3(1.5F), 1.0F, 0.0F})
        .environment(vec3(0.2F));
    const SceneOnDevice scene(builder.scene());
    ASSERT_EQ(scene.flat.lights.size(), 7U);
    std::vector<std::uint32_t> lit(7, 0);
    for (const Result& result : sample(scene)) {
        lit[result.light] += result.lit;
    }
    for (std::size_t i = 0; i < lit.size(); ++i) {
        EXPECT_GT(lit[i], 1000U) << "light " << i;
        EXPECT_LT(scene.flat.lights[i].probability, 0.9F) << "light " << i;
    }
}

}  // namespace
}  // namespace glim
