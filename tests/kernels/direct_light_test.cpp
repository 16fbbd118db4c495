// The two ways in which a path finds light, by light sampling and by chance, against radiance, pdfs and weights in double.
#include "shaders/shared/course_types.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace glim::direct_light_test {

using glm::dot;
using glm::dvec3;

constexpr double kPi = std::numbers::pi;
const dvec3 kAlbedo(0.9, 0.6, 0.3), kEmission(5.0, 4.0, 3.0);

struct Case {
    vec3 point, ns, ng, towards;
    PathState state;
};

struct Result {
    uint asks;
    ShadowRay ray;
    uint finds;
    vec3 found;
};

double powerWeight(double f, double g) { return f * f / (f * f + g * g); }

void expectLight(const vec3& light, const dvec3& expected)
{
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(static_cast<double>(light[k]), expected[k], 1e-4 * expected[k]);
    }
}

// Receivers about the origin, whose normals lean up to 40 degrees off the direction of +y and off each other.
std::vector<Case> receivers(float pdf)
{
    Random random(31);
    std::vector<Case> cases;
    for (int i = 0; i < 4000; ++i) {
        Case c{};
        c.point = 0.1 * random.normalVector();
        c.ng = glm::normalize(dvec3(0, 1, 0) + 0.6 * random.direction());
        c.ns = glm::normalize(dvec3(c.ng) + 0.6 * random.direction());
        c.towards = glm::normalize(dvec3(0, 1, 0) + 0.5 * random.direction());
        c.state = {{0.5F, 1.0F, 2.0F}, pdf, 0.7F, 1.0F, 1, 0};
        cases.push_back(c);
    }
    return cases;
}

// With the course's kernels: those of production have one estimator only.
std::vector<Result> runCourse(const SceneOnDevice& scene, uint direct, const std::vector<Case>& cases)
{
    const Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    KernelTest test = scene.test(test_kernels::course_direct_light_test);
    test.buffers({{kBindNote, &note}}).specialize(kSpecDirect, direct);
    test.parameters().environment = scene.flat.environment;
    test.parameters().environmentLight = scene.flat.environmentLight;
    test.lightRound().light = direct == kDirectMis ? kAnyLight : 0;
    test.lightRound().lightSamples = 4;
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

std::vector<Result> run(const SceneOnDevice& scene, const std::vector<Case>& cases)
{
    const Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    KernelTest test = scene.test(test_kernels::direct_light_test);
    test.buffers({{kBindNote, &note}});
    test.parameters().environment = scene.flat.environment;
    test.parameters().environmentLight = scene.flat.environmentLight;
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// Production, then the course's estimators.
std::vector<std::pair<uint, std::vector<Result>>> runAll(const SceneOnDevice& scene, std::initializer_list<uint> estimators,
                                                         const std::vector<Case>& cases)
{
    std::vector<std::pair<uint, std::vector<Result>>> all = {{kDirectMis, run(scene, cases)}};
    for (const uint direct : estimators) {
        all.emplace_back(direct, runCourse(scene, direct, cases));
    }
    return all;
}

// What light of radiance `radiance` and density `pdf` along wi brings to the camera; zero below the surface. A pdf of 0 is a delta light,
// whose MIS weight is 1.
dvec3 contribution(const Case& c, const dvec3& wi, const dvec3& radianceOverPdf, double pdf, uint direct)
{
    const double cosine = dot(wi, dvec3(c.ns));
    if (cosine <= 0.0 || dot(wi, dvec3(c.ng)) <= 0.0) {
        return dvec3(0.0);
    }
    const double weight = direct == kDirectLights ? 0.25 : pdf > 0.0 ? powerWeight(pdf, cosine / kPi) : 1.0;
    return dvec3(c.state.throughput) * kAlbedo / kPi * radianceOverPdf * cosine * weight;
}

bool isNearHorizon(const Case& c, const dvec3& wi)
{
    return std::abs(dot(wi, dvec3(c.ns))) < 1e-3 || std::abs(dot(wi, dvec3(c.ng))) < 1e-3;
}

// A quad of 4 square metres, two above the origin, facing down.
constexpr double kHeight = 2.0;

SceneOnDevice quadScene()
{
    SceneBuilder builder;
    builder.quad({vec3(-1, -50, -1), {1, -50, -1}, {1, -50, 1}, {-1, -50, 1}}, builder.lambert(vec3(kAlbedo)));
    builder.quad({vec3(-1, 2, -1), {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, builder.lambert(vec3(0.0F), vec3(kEmission)));
    return SceneOnDevice(builder.scene());
}

// One over the solid angle, which is a sum over the corners.
double quadPdf(const vec3& point)
{
    const dvec3 p(point);
    double solidAngle = 0.0;
    for (const double i : {-1.0, 1.0}) {
        for (const double k : {-1.0, 1.0}) {
            const double x = i - p.x, z = k - p.z, h = kHeight - p.y;
            solidAngle += i * k * std::atan(x * z / (h * std::sqrt(x * x + z * z + h * h)));
        }
    }
    return 1.0 / solidAngle;
}

TEST(DirectLightKernelTest, SamplesOfASurfaceAreWeighted)
{
    const SceneOnDevice scene = quadScene();
    const std::vector<Case> cases = receivers(0.0F);
    for (const auto& [direct, results] : runAll(scene, {kDirectMis, kDirectLights}, cases)) {
        std::size_t asked = 0;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Result& r = results[i];
            if (r.asks == 0) {
                continue;
            }
            ++asked;
            const dvec3 to(r.ray.direction), wi = glm::normalize(to);
            EXPECT_EQ(r.ray.tMax, 1.0F);
            EXPECT_EQ(r.ray.target / 2, 1U) << "the lamp's triangles are 2 and 3: it does not shadow itself";
            EXPECT_NEAR(static_cast<double>(r.ray.origin.y) + to.y, kHeight, 1e-5);
            const double pdf = quadPdf(cases[i].point);
            if (!isNearHorizon(cases[i], wi)) {
                expectLight(r.ray.contribution, contribution(cases[i], wi, kEmission / pdf, pdf, direct));
            }
        }
        EXPECT_GT(asked, cases.size() / 2);
        EXPECT_LT(asked, cases.size()) << "some of the light lies below the surface";
    }
}

TEST(DirectLightKernelTest, WhatARayFindsIsWeightedAgainstThat)
{
    const SceneOnDevice scene = quadScene();
    for (const float pdf : {0.0F, 0.05F, 0.3F}) {
        const std::vector<Case> cases = receivers(pdf);
        for (const auto& [direct, results] : runAll(scene, {kDirectMis, kDirectLights, kDirectBsdf}, cases)) {
            std::size_t found = 0;
            for (std::size_t i = 0; i < cases.size(); ++i) {
                if (results[i].finds == 0) {
                    continue;
                }
                ++found;
                const double other = quadPdf(cases[i].point);
                const bool alone = pdf == 0.0F || direct == kDirectBsdf;  // nothing else can find it
                const double weight = alone ? 1.0 : direct == kDirectMis ? powerWeight(static_cast<double>(pdf), other) : 0.0;
                expectLight(results[i].found, weight * kEmission);
            }
            EXPECT_GT(found, cases.size() / 4);
        }
    }
}

TEST(DirectLightKernelTest, APointLightCountsWhole)
{
    SceneBuilder builder;
    builder.sphere(vec3(0, -9, 0), 1.0F, builder.lambert(vec3(kAlbedo)));
    builder.light({"", PunctualLight::Kind::Point, {0.3F, 2, 0}, {0, -1, 0}, vec3(kEmission)});
    const std::vector<Case> cases = receivers(0.0F);
    const std::vector<Result> results = run(SceneOnDevice(builder.scene()), cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const dvec3 to = dvec3(0.3F, 2, 0) - dvec3(cases[i].point), wi = glm::normalize(to);
        if (isNearHorizon(cases[i], wi)) {
            continue;
        }
        const dvec3 expected = contribution(cases[i], wi, kEmission / dot(to, to), 0.0, kDirectMis);
        ASSERT_EQ(results[i].asks != 0, expected != dvec3(0.0)) << i;
        if (results[i].asks != 0) {
            expectLight(results[i].ray.contribution, expected);
            EXPECT_LT(glm::distance(dvec3(results[i].ray.direction), to), 1e-5);
            EXPECT_EQ(results[i].ray.target, kNoPrimitive);
        }
    }
}

TEST(DirectLightKernelTest, TheEnvironmentIsFoundAsItIsSampled)
{
    SceneBuilder builder;
    builder.sphere(vec3(0, -9, 0), 1.0F, builder.lambert(vec3(kAlbedo)));
    builder.environment(vec3(kEmission));
    const SceneOnDevice scene(builder.scene());
    const std::vector<Case> cases = receivers(0.2F);
    const std::vector<Result> results = run(scene, cases);
    std::size_t found = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (results[i].asks != 0) {
            const dvec3 wi(results[i].ray.direction);
            const double pdf = dot(wi, dvec3(cases[i].ns)) / kPi;  // the cosine's, and the only light
            EXPECT_EQ(results[i].ray.tMax, std::numeric_limits<float>::infinity());
            if (!isNearHorizon(cases[i], wi)) {
                expectLight(results[i].ray.contribution, contribution(cases[i], wi, kEmission / pdf, pdf, kDirectMis));
            }
        }
        if (results[i].finds == 0) {
            ++found;
            expectLight(results[i].found, dvec3(cases[i].state.throughput) * kEmission *
                                              powerWeight(static_cast<double>(0.2F), static_cast<double>(0.7F) / kPi));
        }
    }
    EXPECT_GT(found, cases.size() / 2);
}

}  // namespace glim::direct_light_test
