// Where paths continue, against the laws of each material in double.
#include "shaders/shared/course_types.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::next_ray_test {

using glm::dot;
using glm::dvec3;

constexpr uint kOf[] = {kLambert, kMirror, kDielectric};  // by material
constexpr uint kMetal = 3;
constexpr double kIndex = 1.5;
const vec3 kColor(0.9F, 0.6F, 0.3F);

// GLSL's bool is a word.
struct SurfaceInteraction {
    vec3 p, errorBound, ng, ns;
    vec2 uv;
    uint front, material, primitive, light, triangle, instance;
};

struct Case {
    SurfaceInteraction si;
    PathRay ray;
    PathState state;
};

struct Result {
    uint alive;
    PathRay ray;
    PathState state;
};

// Shading normals up to some 80 degrees off the geometric ones, so that now and then they look away from where the path came from.
Case makeCase(Random& random, uint material, uint bounce, double lean)
{
    Case c{};
    const dvec3 n = random.direction();
    dvec3 wo = random.direction();
    wo = dot(wo, n) < 0.0 ? -wo : wo;
    c.si = {random.normalVector(),
            vec3(1e-6F),
            n,
            glm::normalize(n + lean * random.direction()),
            vec2(0.0F),
            random.below(2),
            material,
            77,
            0,
            0,
            kNoInstance};
    c.ray = {vec3(0.0F), 5, -wo, 0};
    c.state = {{random.uniform(0.1, 1.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)}, 0.5F, 0.5F, 1.0F, bounce, 0};
    return c;
}

class NextRayTest : public testing::Test {
protected:
    // Materials 0 to 3; and something to be a scene.
    NextRayTest()
    {
        SceneBuilder builder;
        builder.sphere(vec3(0.0F), 1.0F, builder.lambert(kColor));
        builder.mirror(kColor);
        builder.glass(static_cast<float>(kIndex));
        builder.sphere(vec3(3.0F), 1.0F, builder.lambert(kColor));
        builder.light({}).light({});  // lights are chosen by the normal
        Scene scene = builder.scene();
        scene.materials[kMetal].metallic = 0.5F;
        scene.materials[kMetal].roughness = 0.7F;
        scene_.emplace(scene);
        upload(note_, std::span<const PathNote>(std::vector<PathNote>(1)));
    }
    KernelTest test(const EmbeddedShader& shader = test_kernels::next_ray_test)
    {
        KernelTest test = scene_->test(shader);
        test.features(scene_->flat.features | kFeatureMirror | kFeatureDielectric).buffers({{kBindNote, &note_}});
        test.parameters().seed = 3;
        test.parameters().maxBounces = 64;
        return test;
    }
    static std::vector<Result> run(KernelTest test, const std::vector<Case>& cases)
    {
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        return test.results<Result>();
    }
    std::vector<Case> cases(std::size_t count, uint material, uint bounce, double lean)
    {
        std::vector<Case> cases;
        for (std::size_t i = 0; i < count; ++i) {
            cases.push_back(makeCase(random_, material, bounce, lean));
        }
        return cases;
    }

    Random random_{21};
    std::optional<SceneOnDevice> scene_;
    Buffer note_{testDevice(), "test's note", BufferKind::Storage, sizeof(PathNote)};
};

// The shading normal on the side of wo, or the geometric one.
dvec3 turned(const Case& c)
{
    const dvec3 ns(c.si.ns);
    return dot(ns, -dvec3(c.ray.direction)) > 0.0 ? ns : dvec3(c.si.ng);
}

void expectThroughput(const Case& c, const Result& r, const dvec3& weight)
{
    for (int k = 0; k < 3; ++k) {
        const double expected = static_cast<double>(c.state.throughput[k]) * weight[k];
        EXPECT_NEAR(static_cast<double>(r.state.throughput[k]), expected, 1e-5 * expected);
    }
}

// What holds for every ray that continues a path.
void expectLeaves(const Case& c, const Result& r)
{
    const dvec3 wi(r.ray.direction), n(c.si.ng), off = dvec3(r.ray.origin) - dvec3(c.si.p);
    EXPECT_NEAR(glm::length(wi), 1.0, 1e-6);
    EXPECT_EQ(r.ray.source, 77U);
    EXPECT_EQ(r.state.bounce, c.state.bounce + 1);
    EXPECT_GT(dot(off, n) * dot(wi, n), 0.0) << "on the side that the ray goes to";
    EXPECT_LT(glm::length(off), 4e-6) << "the error bound and rounding";
}

TEST_F(NextRayTest, LambertFollowsTheCosine)
{
    const std::vector<Case> all = cases(20000, 0, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::vector<double> died;
    double expected = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 ns = turned(all[i]), ng(all[i].si.ng);
        // The share of a cosine-weighted hemisphere that lies below a plane tilted by an angle: (1 - cos) / 2.
        const double share = 0.5 * (1.0 - dot(glm::normalize(ns), glm::normalize(ng)));
        expected += share;
        died.push_back(results[i].alive != 0 ? -share : 1.0 - share);
        if (results[i].alive != 0) {
            const dvec3 wi(results[i].ray.direction);
            expectLeaves(all[i], results[i]);
            expectThroughput(all[i], results[i], dvec3(kColor));
            EXPECT_GT(dot(wi, ng), -1e-6);
            EXPECT_NEAR(static_cast<double>(results[i].state.cosine), dot(wi, ns), 1e-6);
            EXPECT_NEAR(static_cast<double>(results[i].state.pdf), dot(wi, ns) / std::numbers::pi, 1e-6);
            EXPECT_EQ(results[i].state.etaScale, 1.0F);
        }
    }
    EXPECT_GT(expected, 1000.0);
    expectSampleMean("paths that end below the surface, less their share", died, 0.0, 1);
}

TEST_F(NextRayTest, MirrorsReflectAboutANormalThatKeepsLightOutside)
{
    const std::vector<Case> all = cases(5000, 1, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::size_t fallen = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 wo = -dvec3(all[i].ray.direction), ng(all[i].si.ng);
        dvec3 n = glm::normalize(turned(all[i]));
        if (dot(2.0 * dot(wo, n) * n - wo, ng) <= 0.0) {
            n = ng;
            ++fallen;
        }
        const dvec3 expected = 2.0 * dot(wo, n) * n - wo;
        if (std::abs(dot(expected, ng)) < 1e-5) {
            continue;  // rounding decides
        }
        ASSERT_EQ(results[i].alive, 1U);
        expectLeaves(all[i], results[i]);
        EXPECT_LT(glm::distance(dvec3(results[i].ray.direction), expected), 3e-6);
        expectThroughput(all[i], results[i], dvec3(kColor) + (1.0 - dvec3(kColor)) * std::pow(1.0 - dot(wo, n), 5.0));
        EXPECT_EQ(results[i].state.pdf, 0.0F);
        EXPECT_EQ(results[i].state.etaScale, 1.0F);
    }
    EXPECT_GT(fallen, all.size() / 50);
}

TEST_F(NextRayTest, GlassTakesTheShadingNormalsSide)
{
    const std::vector<Case> all = cases(5000, 2, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::size_t passed = 0, behind = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 wo = -dvec3(all[i].ray.direction), wi(results[i].ray.direction);
        const bool isBehind = dot(wo, dvec3(all[i].si.ns)) < 0.0;
        const dvec3 n = glm::normalize(isBehind ? -dvec3(all[i].si.ns) : dvec3(all[i].si.ns));
        const double eta = (all[i].si.front != 0) != isBehind ? kIndex : 1.0 / kIndex;
        ASSERT_EQ(results[i].alive, 1U);
        EXPECT_EQ(results[i].state.pdf, 0.0F);
        behind += isBehind ? 1 : 0;
        if (dot(wi, n) > 0.0) {
            EXPECT_LT(glm::distance(wi, 2.0 * dot(wo, n) * n - wo), 3e-6);
            expectThroughput(all[i], results[i], dvec3(1.0));
            EXPECT_EQ(results[i].state.etaScale, 1.0F);
        } else {
            ++passed;
            EXPECT_LT(glm::distance(glm::cross(wi, n) * eta, -glm::cross(wo, n)), 1e-5) << "Snell's law";
            expectThroughput(all[i], results[i], dvec3(1.0 / (eta * eta)));
            EXPECT_NEAR(static_cast<double>(results[i].state.etaScale), eta * eta, 1e-6 * eta * eta);
        }
    }
    EXPECT_GT(passed, all.size() / 2);
    EXPECT_GT(behind, all.size() / 50);
}

// The kernel compares evalAndSampleBsdf with the two calls apart.
TEST_F(NextRayTest, AHalfMetalIsEvaluatedAndSampledAtOnce)
{
    ASSERT_NE(scene_->flat.features & kFeaturePrincipled, 0U);
    const std::vector<Case> all = cases(4000, kMetal, 0, 0.0);
    std::size_t alive = 0;
    for (const Result& r : run(test(), all)) {
        alive += r.alive;
    }
    EXPECT_GT(alive, all.size() / 2);
}

TEST_F(NextRayTest, RouletteKeepsTheMean)
{
    const std::vector<Case> all = cases(20000, 1, 1, 0.0);
    KernelTest fixed = test(test_kernels::course_bounce_test);
    fixed.specialize(kSpecRoulette, kRouletteFixed);
    fixed.course().continuation = 0.25F;
    const std::vector<Result> plain = run(test(), all), played = run(std::move(fixed), all);
    std::vector<double> alive;
    for (std::size_t i = 0; i < all.size(); ++i) {
        alive.push_back(played[i].alive);
        if (played[i].alive != 0) {
            EXPECT_EQ(played[i].state.throughput, 4.0F * plain[i].state.throughput);
        }
    }
    expectSampleMean("paths that go on", alive, 0.25, 1);
}

// Light sampling has already found what the last ray of a diffuse surface could find. Nothing else finds what a mirror shows.
TEST_F(NextRayTest, TheLastRayIsTracedOnlyForWhatItAloneFinds)
{
    for (const uint material : {0U, 1U, 2U}) {
        for (const uint direct : {kDirectMis, kDirectLights, kDirectHemisphere, kDirectBsdf}) {
            for (const uint maxBounces : {2U, 3U}) {
                KernelTest last = test(test_kernels::course_bounce_test);
                last.specialize(kSpecDirect, direct);
                last.parameters().maxBounces = maxBounces;
                const bool none = kOf[material] == kLambert && maxBounces == 2 && (direct == kDirectLights || direct == kDirectHemisphere);
                const std::vector<Result> results = run(std::move(last), cases(100, material, 1, 0.0));
                EXPECT_EQ(std::ranges::count(results, 1U, &Result::alive), none ? 0 : 100)
                    << material << ", " << direct << ", " << maxBounces;
            }
        }
    }
}

}  // namespace glim::next_ray_test
