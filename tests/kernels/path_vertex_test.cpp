// A path's vertex on a floor that lies in the plane y = 0, below a point light or an environment, against what it is on paper.
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim::path_vertex_test {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr uint kMaxBounces = 2;
const dvec3 kAlbedo(0.9, 0.6, 0.3), kEmission(5.0, 4.0, 3.0), kLamp(0.5, 3.0, -0.2), kIntensity(7.0, 8.0, 9.0), kSky(1.0, 2.0, 3.0);

struct Case {
    PathRay ray;
    PathState state;
};

struct Result {
    vec3 emitted;
    uint emittedGroup, shadowGroup, environmentGroup;
    FirstHit firstHit;
    uint hasShadowRay;
    ShadowRay shadowRay;
    uint hasNextRay;
    PathRay ray;
    PathState state;
};

// From one metre above the floor, downwards, as rays that have met 0, 1 or kMaxBounces surfaces and that light sampling cannot replace.
std::vector<Case> downwardRays()
{
    Random random(47);
    std::vector<Case> cases;
    for (uint i = 0; i < 3000; ++i) {
        Case c{};
        c.ray.origin = {random.uniform(-2.0, 2.0), 1.0, random.uniform(-2.0, 2.0)};
        c.ray.source = kNoPrimitive;
        c.ray.direction = glm::normalize(dvec3(0, -1, 0) + 0.7 * random.direction());
        c.state = {{0.5F, 1.0F, 2.0F}, 0.0F, 0.0F, 1.0F, i % (kMaxBounces + 1), 0};
        cases.push_back(c);
    }
    return cases;
}

SceneBuilder floorWith(const dvec3& emission)
{
    SceneBuilder builder;
    builder.quad({vec3(-50, 0, 50), {50, 0, 50}, {50, 0, -50}, {-50, 0, -50}}, builder.lambert(vec3(kAlbedo), vec3(emission)));
    return builder;
}

std::vector<Result> shade(const SceneBuilder& builder, const std::vector<Case>& cases)
{
    Scene grouped = builder.scene();
    grouped.lightGroups.resize(kMaxLightGroups);
    const SceneOnDevice scene(grouped);
    const Buffer note(testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote));
    KernelTest test = scene.test(test_kernels::path_vertex_test);
    test.buffers({{kBindNote, &note}});
    test.parameters().environment = scene.flat.environment;
    test.parameters().environmentLight = scene.flat.environmentLight;
    test.parameters().maxBounces = kMaxBounces;
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// Float32 rounds each of some twenty operations by 2^-24.
void expectNear(const vec3& actual, const dvec3& expected)
{
    EXPECT_LE(glm::distance(dvec3(actual), expected), 2e-6 * (1e-6 + glm::length(expected)));
}

dvec3 pointOf(const PathRay& ray)
{
    const dvec3 origin(ray.origin), direction(ray.direction);
    return origin - direction * (origin.y / direction.y);
}

TEST(PathVertexTest, ASurfaceIsLitFromALampUntilTheLastBounce)
{
    SceneBuilder builder = floorWith(dvec3(0.0));
    PunctualLight lamp;
    lamp.kind = PunctualLight::Kind::Point;
    lamp.position = vec3(kLamp);
    lamp.intensity = vec3(kIntensity);
    lamp.group = 5;
    builder.light(lamp);
    const std::vector<Case> cases = downwardRays();
    const std::vector<Result> results = shade(builder, cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        const Result& r = results[i];
        const bool last = c.state.bounce == kMaxBounces;
        EXPECT_EQ(r.emitted, vec3(0.0F));
        expectNear(r.firstHit.albedo, kAlbedo);
        EXPECT_EQ(r.firstHit.normal, vec3(0, 1, 0));
        ASSERT_EQ(r.hasShadowRay, last ? 0U : 1U);
        ASSERT_EQ(r.hasNextRay, last ? 0U : 1U);
        if (last) {
            continue;
        }
        // From where the shadow ray starts, which is the floor but for the offset against its rounding errors.
        const dvec3 toLamp = kLamp - dvec3(r.shadowRay.origin);
        const double distance = glm::length(toLamp), cosine = toLamp.y / distance;
        EXPECT_LT(glm::distance(dvec3(r.shadowRay.origin), pointOf(c.ray)), 1e-4);
        EXPECT_EQ(r.shadowGroup, 5U);
        expectNear(r.shadowRay.contribution, dvec3(c.state.throughput) * kAlbedo / kPi * cosine * kIntensity / (distance * distance));
        expectNear(r.shadowRay.direction, toLamp);
        EXPECT_EQ(r.shadowRay.tMax, 1.0F);
        EXPECT_EQ(r.shadowRay.target, kNoPrimitive);
        EXPECT_EQ(r.ray.origin, r.shadowRay.origin) << "both go upwards";
        EXPECT_EQ(r.ray.source, r.shadowRay.source);
        EXPECT_GT(r.ray.origin.y, 0.0F);
        EXPECT_GT(r.ray.direction.y, 0.0F);
        EXPECT_EQ(r.state.bounce, c.state.bounce + 1);
        expectNear(r.state.throughput, dvec3(c.state.throughput) * kAlbedo);
        EXPECT_NEAR(static_cast<double>(r.state.pdf), static_cast<double>(r.ray.direction.y) / kPi, 1e-6);
    }
}

// A floor does not light itself: its light samples carry nothing.
TEST(PathVertexTest, ASurfaceEmitsWhatLightSamplingCannotFind)
{
    const std::vector<Case> cases = downwardRays();
    SceneBuilder builder = floorWith(dvec3(0.0));
    Material lamp = makeLambert(vec3(kAlbedo), vec3(kEmission));
    lamp.lightGroup = 3;
    builder.quad({vec3(-50, 0.001F, 50), {50, 0.001F, 50}, {50, 0.001F, -50}, {-50, 0.001F, -50}}, builder.add(lamp));
    for (const Result& r : shade(builder, cases)) {
        EXPECT_EQ(r.emittedGroup, 3U);
        expectNear(r.emitted, dvec3(cases[0].state.throughput) * kEmission);
        EXPECT_EQ(r.hasShadowRay, 0U);
    }
}

TEST(PathVertexTest, AMissHasTheEnvironmentByItsMisWeight)
{
    std::vector<Case> cases = downwardRays();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        cases[i].ray.direction.y *= -1.0F;
        cases[i].state.cosine = cases[i].ray.direction.y;
        cases[i].state.pdf = i % 2 == 0 ? 0.0F : 0.5F;
    }
    const std::vector<Result> results = shade(floorWith(dvec3(0.0)).environment(vec3(kSky)), cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const PathState& state = cases[i].state;
        const double pdf = static_cast<double>(state.pdf), lightPdf = static_cast<double>(state.cosine) / kPi;
        const double weight = pdf > 0.0 ? pdf * pdf / (pdf * pdf + lightPdf * lightPdf) : 1.0;
        expectNear(results[i].emitted, weight * dvec3(state.throughput) * kSky);
        EXPECT_EQ(results[i].environmentGroup, 0U);
    }
}

}  // namespace glim::path_vertex_test
