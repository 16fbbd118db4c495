// H10: shadow rays where light, blocker and receiver touch.
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/irradiance.hpp"
#include "tests/support/irradiance_formulas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim::contact_test {

using glm::dvec3;
using glm::vec3;

// Far above the rounding of coordinates, far below what a picture resolves.
constexpr float kLookUp = 1e-3F;

std::array<vec3, 4> floorQuad() { return {vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}; }
std::array<vec3, 4> downQuad(float half, float y) { return {vec3(-half, y, -half), {half, y, -half}, {half, y, half}, {-half, y, half}}; }

// A light in the plane of the ceiling, and 1e-4 below it. The floor sees all of it, the ceiling nothing.
TEST(ContactTest, H10LightOnACeiling)
{
    for (const float gap : {0.0F, 1e-4F}) {
        SceneBuilder builder;
        const auto white = builder.lambert(vec3(0.5F));
        builder.quad(floorQuad(), white).quad(downQuad(4.0F, 2.0F), white);
        builder.quad(downQuad(0.5F, 2.0F - gap), builder.lambert(vec3(0.0F), vec3(1.0F)));
        std::vector<Receiver> receivers;
        for (const vec3& point : {vec3(0, 0, 0), vec3(0.7F, 0, 0.3F), vec3(-2.5F, 0, 1)}) {
            std::vector<dvec3> corners;
            for (const vec3& corner : downQuad(0.5F, 2.0F - gap)) {
                corners.push_back(dvec3(corner) - dvec3(point));
            }
            receivers.push_back({point, {0, 1, 0}, computePolygonIrradiance(corners, {0, 1, 0}), kLookUp});
        }
        if (gap == 0.0F) {
            receivers.push_back({{0.6F, 2, 0.1F}, {0, -1, 0}, 0.0, kLookUp});
        }
        expectIrradiance("light on a ceiling", builder.scene(), receivers);
    }
}

// The irradiance that a floor gets from a sphere of radiance 1, by rays with t > epsilon over a grid of cosine-weighted
// directions.
double irradianceBeyond(double epsilon, const dvec3& center, double radius)
{
    constexpr int kSide = 512;
    int found = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const double u = (i % kSide + 0.5) / kSide, phi = 2.0 * std::numbers::pi * (i / kSide + 0.5) / kSide;
        const dvec3 w(std::sqrt(u) * std::cos(phi), std::sqrt(1.0 - u), std::sqrt(u) * std::sin(phi));
        const double middle = glm::dot(center, w), square = middle * middle - glm::dot(center, center) + radius * radius;
        found += square > 0.0 && middle - std::sqrt(square) > epsilon ? 1 : 0;
    }
    return std::numbers::pi * found / (kSide * kSide);
}

// A sphere light resting on the floor, up to 1e-3 of where they touch.
TEST(ContactTest, H10SphereLightOnTheFloor)
{
    SceneBuilder builder;
    builder.quad(floorQuad(), builder.lambert(vec3(0.5F)));
    builder.sphere({0, 0.5F, 0}, 0.5F, builder.lambert(vec3(0.0F), vec3(1.0F)));
    std::vector<Receiver> receivers;
    for (const float x : {2.0F, 0.5F, 0.1F, 0.03F, 0.01F}) {
        const double truth = computeSphereIrradiance({-static_cast<double>(x), 0.5, 0}, 0.5, {0, 1, 0});
        // Looked up from below the sphere's underside, which is x^2 / (2 r) above the floor.
        receivers.push_back({{x, 0, 0}, {0, 1, 0}, truth, std::min(kLookUp, 0.5F * x * x)});
    }
    // Rays leave a floor of 10 m by 6e-6 m, which is 6 % of the gap at the last receiver: the cone differs by that.
    const auto nearest = expectIrradiance("sphere light on the floor", builder.scene(), receivers, 1e-3).back();
    const double truth = receivers.back().truth, naive = irradianceBeyond(1e-3, {-0.01, 0.5, 0.0}, 0.5) / truth;
    printHardCase("H10", "1 cm from where a sphere light touches", static_cast<double>(hardTrials(2048 * 64)),
                  "irradiance x " + figure(nearest.mean / truth), "rays from t > 1e-3: x " + figure(naive));
    EXPECT_NEAR(irradianceBeyond(0.0, {-0.01, 0.5, 0.0}, 0.5), truth, 1e-3 * truth) << "only where they begin is wrong";
    EXPECT_LT(naive, 0.5);
}

// A black sphere resting on the floor, a point light: lit where the segment clears the sphere.
TEST(ContactTest, H10SphereOnTheFloorCastsItsShadowToTheContact)
{
    const dvec3 lamp(3, 4, 0), center(0, 0.5, 0);
    SceneBuilder builder;
    builder.quad(floorQuad(), builder.lambert(vec3(0.5F)));
    builder.sphere({0, 0.5F, 0}, 0.5F, builder.lambert(vec3(0.0F)));
    builder.light({"", PunctualLight::Kind::Point, vec3(lamp), {0, 0, -1}, vec3(2.0F)});
    std::vector<Receiver> receivers;
    int dark = 0;
    for (const float x : {-3.0F, -1.0F, -0.6F, -0.3F, -0.1F, -0.01F, 0.01F, 0.1F, 0.2F, 0.3F, 0.5F, 1.0F, 4.0F}) {
        const dvec3 point(static_cast<double>(x), 0, 0), towards = lamp - point;
        const double t = glm::dot(center - point, towards) / glm::dot(towards, towards);
        const bool blocked = t > 0.0 && glm::length(point + t * towards - center) < 0.5;
        const double truth = blocked ? 0.0 : 2.0 * 4.0 / std::pow(glm::length(towards), 3.0);
        receivers.push_back({vec3(point), {0, 1, 0}, truth, std::min(kLookUp, 0.5F * x * x)});
        dark += blocked ? 1 : 0;
    }
    expectExactIrradiance("shadow of a resting sphere", builder.scene(), receivers);
    EXPECT_TRUE(dark > 4 && dark < 10) << dark;
}

// Emitter and receiver at once: a closed box that emits inwards gives pi to each point of its walls, most of it from lights
// that share an edge with the receiver. A wall alone gives itself nothing.
TEST(ContactTest, H10EmitterIsTheReceiver)
{
    SceneBuilder box;
    box.cube(1.0F, box.lambert(vec3(0.0F), vec3(1.0F)), true);
    expectIrradiance("box of light", box.scene(),
                     {{{0.3F, -1, 0.2F}, {0, 1, 0}, std::numbers::pi, kLookUp},
                      {{1, 0.5F, -0.4F}, {-1, 0, 0}, std::numbers::pi, kLookUp},
                      {{-0.7F, 0.6F, 1}, {0, 0, -1}, std::numbers::pi, kLookUp}});
    SceneBuilder alone;
    alone.quad(floorQuad(), alone.lambert(vec3(0.0F), vec3(1.0F), true));
    alone.sphere({0, -20, 0}, 1.0F, alone.lambert(vec3(0.5F)));
    expectIrradiance("wall of light", alone.scene(), {{{0.3F, 0, 0.2F}, {0, 1, 0}, 0.0, kLookUp}});
    SceneBuilder ball;
    ball.sphere({0, 0, 0}, 1.0F, ball.lambert(vec3(0.0F), vec3(1.0F)));
    expectIrradiance("ball of light", ball.scene(),
                     {{{1, 0, 0}, {1, 0, 0}, 0.0, kLookUp}, {{0, -0.6F, 0.8F}, {0, -0.6F, 0.8F}, 0.0, kLookUp}});
}

}  // namespace glim::contact_test
