// The light that arrives at a receiver: the sampler's estimates against formulas (T9 to T13, H11).
#include "tests/support/build_scene.hpp"
#include "tests/support/irradiance.hpp"
#include "tests/support/irradiance_formulas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::light_test {

using glm::dvec3;
using glm::vec3;

constexpr double kPi = std::numbers::pi;

// A triangle far away, since the tree must hold something.
void addSpeck(SceneBuilder& builder) { builder.sphere({0.0F, -50.0F, 0.0F}, 0.1F, builder.lambert(vec3(0.5F))); }

vec3 tilted(float degrees)
{
    const double radians = static_cast<double>(degrees) * kPi / 180.0;
    return vec3(dvec3(std::sin(radians), std::cos(radians), 0.0));
}

TEST(LightTest, H16PointAndDirectionalAreExact)
{
    SceneBuilder point;
    addSpeck(point);
    point.light({"", PunctualLight::Kind::Point, {1, 2, 3}, {0, 0, -1}, vec3(5.0F)});
    const double d2 = 14.0, along = 2.0;
    expectExactIrradiance("T9 point", point.scene(),
                          {{vec3(0.0F), {0, 1, 0}, 5.0 * along / (d2 * std::sqrt(d2))}, {vec3(0.0F), {0, -1, 0}, 0.0}});
    SceneBuilder directional;
    addSpeck(directional);
    directional.light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0.6F, -0.8F, 0}, vec3(3.0F)});
    expectExactIrradiance("T9 directional", directional.scene(),
                          {{vec3(7.0F), {0, 1, 0}, 2.4}, {vec3(7.0F), {-0.6F, 0.8F, 0}, 3.0}, {vec3(0.0F), {0, -1, 0}, 0.0}});
}

TEST(LightTest, SpotFallsOffBetweenItsCones)
{
    const double inner = 0.95, outer = 0.8, height = 2.0, intensity = 7.0;
    SceneBuilder spot;
    addSpeck(spot);
    spot.light({"", PunctualLight::Kind::Spot, {0, 2, 0}, {0, -1, 0}, vec3(7.0F), 0.05F, 0.2F});
    std::vector<Receiver> receivers;
    for (const float x : {0.0F, 0.5F, 0.8F, 1.0F, 1.3F, 2.0F, -1.1F}) {
        const double d2 = static_cast<double>(x * x) + height * height, cosine = height / std::sqrt(d2);
        const double ramp = std::min(1.0, std::max(0.0, (cosine - outer) / (inner - outer)));
        receivers.push_back({{x, 0, 0}, {0, 1, 0}, intensity * ramp * ramp * cosine / d2});
    }
    // Not exact: near the rim the ramp's rounding error grows by 1 / (cosine - outer).
    expectIrradiance("spot", spot.scene(), receivers);
}

TEST(LightTest, EnvironmentHasNoVarianceOnAnOpenReceiver)
{
    SceneBuilder builder;
    builder.sphere({3.0F, -1e4F, -2.0F}, 1e-3F, builder.lambert(vec3(0.5F))).environment(vec3(0.7F));
    const double truth = kPi * static_cast<double>(0.7F);
    expectExactIrradiance("T13 environment", builder.scene(), {{{3, 1, -2}, {0, 1, 0}, truth}, {{3, 1, -2}, {1, 0, 0}, truth}});
    // In a tilted frame the cosine of a grazing direction is rounded.
    expectIrradiance("T13 environment", builder.scene(), {{{3, 1, -2}, tilted(45.0F), truth}, {{3, 1, -2}, tilted(80.0F), truth}});
}

TEST(LightTest, SphereAboveAndAcrossTheHorizon)
{
    SceneBuilder builder;
    builder.sphere({0, 2, 0}, 0.75F, builder.lambert(vec3(0.0F), vec3(1.0F)));
    std::vector<Receiver> receivers;
    for (const float degrees : {0.0F, 30.0F, 60.0F, 75.0F, 90.0F, 105.0F, 110.0F, 130.0F}) {
        const vec3 n = tilted(degrees);
        receivers.push_back({vec3(0.0F), n, computeSphereIrradiance({0, 2, 0}, 0.75, glm::normalize(dvec3(n)))});
    }
    expectIrradiance("T10 sphere", builder.scene(), receivers);
}

// H11: r/d from nearly 1 down to 1e-6.
TEST(LightTest, H11SphereConesOfAllSizes)
{
    for (const float ratio : {0.999999F, 0.9F, 0.1F, 1e-2F, 1e-3F, 1e-4F, 1e-5F, 1e-6F}) {
        SceneBuilder builder;
        builder.sphere({0, 0, 1.0F / ratio}, 1.0F, builder.lambert(vec3(0.0F), vec3(1.0F)));
        const double d = static_cast<double>(1.0F / ratio), sin2 = 1.0 / (d * d);
        const auto estimate = expectIrradiance("T10 cone", builder.scene(), {{vec3(0.0F), {0, 0, 1}, kPi * sin2}})[0];
        // 1 - sqrt(1 - sin2) is badly conditioned near 1; 4 ulp of sin2 are granted.
        const double cosine = std::sqrt(1.0 - sin2), oneMinus = sin2 / (1.0 + cosine);
        const double slack = 1e-6 + 4 * 0x1p-24 * sin2 / (2.0 * cosine * oneMinus);
        EXPECT_NEAR(estimate.pdf * 2.0 * kPi * oneMinus, 1.0, slack) << "r/d " << ratio;
    }
}

// Receivers in and on the sphere.
TEST(LightTest, SphereFromWithin)
{
    for (const bool doubleSided : {false, true}) {
        SceneBuilder builder;
        builder.sphere({1, 0, 0}, 2.0F, builder.lambert(vec3(0.0F), vec3(1.0F), doubleSided));
        const double inside = doubleSided ? kPi : 0.0;
        expectIrradiance(doubleSided ? "inside, double-sided" : "inside, front only", builder.scene(),
                         {{{1, 0, 0}, {0, 1, 0}, inside}, {{1.5F, 0.5F, -1}, {0.6F, 0, 0.8F}, inside}, {{1, 1.7F, 0}, {0, 1, 0}, inside}});
        // Exactly on it. The renderer never asks from there; the answer only has to be finite.
        estimateIrradiance(builder.scene(), {{{3, 0, 0}, {1, 0, 0}}, {{1, 2, 0}, {0, -1, 0}}, {{1, 0, -2}, {1, 0, 0}}});
    }
}

std::vector<dvec3> seenFrom(const std::vector<vec3>& corners, const vec3& point)
{
    std::vector<dvec3> seen;
    for (const vec3& corner : corners) {
        seen.push_back(dvec3(corner) - dvec3(point));
    }
    return seen;
}

// An irregular pentagon, its triangles of unequal areas; faces down from height 1.
const std::vector<vec3> kPentagon = {{-1, 1, -1}, {1, 1, -0.5F}, {1.5F, 1, 0.5F}, {0.3F, 1, 1}, {-1.2F, 1, 0.2F}};

TEST(LightTest, PolygonFromBothSidesAndItsPlane)
{
    for (const bool doubleSided : {false, true}) {
        SceneBuilder builder;
        builder.polygon(kPentagon, builder.lambert(vec3(0.0F), vec3(1.0F), doubleSided));
        std::vector<Receiver> receivers;
        for (const vec3& point : {vec3(0, 0, 0), vec3(0, 0.9F, 0), vec3(3, 0.5F, 1), vec3(-0.5F, -10, 2)}) {
            receivers.push_back({point, {0, 1, 0}, computePolygonIrradiance(seenFrom(kPentagon, point), {0, 1, 0})});
        }
        for (const vec3& point : {vec3(0, 2, 0), vec3(1, 1.5F, -2)}) {
            const double truth = computePolygonIrradiance(seenFrom(kPentagon, point), {0, -1, 0});
            receivers.push_back({point, {0, -1, 0}, doubleSided ? truth : 0.0});
        }
        for (const vec3& point : {vec3(4, 1, 0), vec3(0, 1, 0)}) {  // in its plane, beside it and on it
            receivers.push_back({point, {0, 1, 0}, 0.0});
            receivers.push_back({point, {1, 0, 0}, 0.0});
        }
        expectIrradiance(doubleSided ? "T12 polygon, double-sided" : "T12 polygon", builder.scene(), receivers);
    }
}

TEST(LightTest, DiskOfManyTriangles)
{
    constexpr int kCorners = 128;
    std::vector<vec3> rim;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * kPi * i / kCorners;
        rim.emplace_back(dvec3(0.5 * std::cos(angle), 1.0, 0.5 * std::sin(angle)));
    }
    SceneBuilder builder;
    builder.polygon(rim, builder.lambert(vec3(0.0F), vec3(1.0F), true));
    std::vector<Receiver> receivers;
    for (const float offset : {0.0F, 0.5F, 2.0F}) {
        const vec3 point(offset, 0, 0);
        receivers.push_back({point, {0, 1, 0}, computePolygonIrradiance(seenFrom(rim, point), {0, 1, 0})});
        // The areas differ by 2/3 (pi / corners)^2.
        EXPECT_NEAR(receivers.back().truth / computeDiskIrradiance(0.5, 1.0, static_cast<double>(offset)), 1.0, 5e-4);
    }
    expectIrradiance("T11 disk", builder.scene(), receivers);
}

// One light of every kind, none of which hides another.
TEST(LightTest, SumsOverAllLights)
{
    SceneBuilder builder;
    const auto lamp = builder.lambert(vec3(0.0F), vec3(1.0F));
    builder.polygon(kPentagon, lamp).sphere({8, 3, 0}, 0.5F, builder.lambert(vec3(0.0F), vec3(4.0F)));
    builder.light({"", PunctualLight::Kind::Point, {-3, 1, 0}, {0, 0, -1}, vec3(2.0F)})
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {-0.8F, -0.6F, 0}, vec3(0.25F)});
    const vec3 point(0.5F, 0, 0);
    const double directional = 0.25 * 0.6;
    const double pointLight = 2.0 / std::pow(3.5 * 3.5 + 1.0, 1.5);
    const double truth = computePolygonIrradiance(seenFrom(kPentagon, point), {0, 1, 0}) +
                         4.0 * computeSphereIrradiance({7.5, 3, 0}, 0.5, {0, 1, 0}) + pointLight + directional;
    const vec3 free(6, 0, 0);
    const double freeTruth = computePolygonIrradiance(seenFrom(kPentagon, free), {0, 1, 0}) +
                             4.0 * computeSphereIrradiance({2, 3, 0}, 0.5, {0, 1, 0}) + 2.0 / std::pow(82.0, 1.5) + directional;
    expectIrradiance("all lights", builder.scene(), {{point, {0, 1, 0}, truth}, {free, {0, 1, 0}, freeTruth}});
}

}  // namespace glim::light_test
