// Where paths go on, against the laws of each material in double.
#include "test_kernels.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dot;
using glm::dvec3;

constexpr uint kOf[] = {kLambert, kMirror, kGlass};  // by material
constexpr double kIndex = 1.5;
const vec3 kColor(0.9F, 0.6F, 0.3F);

// GLSL's bool is a word.
struct Surface {
    vec3 point, errorBound, geometric, shading;
    uint front, material, emitter, primitive;
};

struct Case {
    Surface surface;
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
    c.surface = {random.normalVector(), vec3(1e-6F), n, glm::normalize(n + lean * random.direction()),
                 random.below(2), material, 0, 77};
    c.ray = {vec3(0.0F), 5, -wo, 0};
    c.state = {{random.uniform(0.1, 1.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0)}, 0.5F, 0.5F, 1.0F, bounce, 0};
    return c;
}

class ScatterPathTest : public testing::Test {
protected:
    // Materials 0 to 2; and something to be a scene.
    ScatterPathTest()
    {
        SceneBuilder builder;
        builder.sphere(vec3(0.0F), 1.0F, builder.lambert(kColor));
        builder.mirror(kColor);
        builder.glass(static_cast<float>(kIndex));
        scene_.emplace(builder.scene());
        upload(note_, std::span<const PathNote>(std::vector<PathNote>(1)));
    }
    KernelTest test()
    {
        KernelTest test = scene_->test(test_kernels::scatter_path_test);
        test.buffers({{kBindNote, &note_}});
        test.pass().seed = 3;
        test.pass().maxBounces = 64;
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
    const dvec3 shading(c.surface.shading);
    return dot(shading, -dvec3(c.ray.direction)) > 0.0 ? shading : dvec3(c.surface.geometric);
}

void expectThroughput(const Case& c, const Result& r, const dvec3& weight)
{
    for (int k = 0; k < 3; ++k) {
        const double expected = static_cast<double>(c.state.throughput[k]) * weight[k];
        EXPECT_NEAR(static_cast<double>(r.state.throughput[k]), expected, 1e-5 * expected);
    }
}

// What holds for every ray that goes on.
void expectLeaves(const Case& c, const Result& r)
{
    const dvec3 wi(r.ray.direction), n(c.surface.geometric), off = dvec3(r.ray.origin) - dvec3(c.surface.point);
    EXPECT_NEAR(glm::length(wi), 1.0, 1e-6);
    EXPECT_EQ(r.ray.source, 77U);
    EXPECT_EQ(r.state.bounce, c.state.bounce + 1);
    EXPECT_GT(dot(off, n) * dot(wi, n), 0.0) << "on the side that the ray goes to";
    EXPECT_LT(glm::length(off), 4e-6) << "the error bound and rounding";
}

TEST_F(ScatterPathTest, LambertFollowsTheCosine)
{
    const std::vector<Case> all = cases(20000, 0, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::vector<double> died;
    double expected = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 shading = turned(all[i]), geometric(all[i].surface.geometric);
        // Of a cosine's hemisphere, what lies below a plane that leans by an angle: (1 - cos) / 2.
        const double share = 0.5 * (1.0 - dot(glm::normalize(shading), glm::normalize(geometric)));
        expected += share;
        died.push_back(results[i].alive != 0 ? -share : 1.0 - share);
        if (results[i].alive != 0) {
            const dvec3 wi(results[i].ray.direction);
            expectLeaves(all[i], results[i]);
            expectThroughput(all[i], results[i], dvec3(kColor));
            EXPECT_GT(dot(wi, geometric), -1e-6);
            EXPECT_NEAR(static_cast<double>(results[i].state.cosine), dot(wi, shading), 1e-6);
            EXPECT_NEAR(static_cast<double>(results[i].state.pdf), dot(wi, shading) / std::numbers::pi, 1e-6);
            EXPECT_EQ(results[i].state.etaScale, 1.0F);
        }
    }
    EXPECT_GT(expected, 1000.0);
    expectSampleMean("paths that end below the surface, less their share", died, 0.0, 1);
}

TEST_F(ScatterPathTest, MirrorsReflectAboutANormalThatKeepsLightOutside)
{
    const std::vector<Case> all = cases(5000, 1, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::size_t fallen = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 wo = -dvec3(all[i].ray.direction), geometric(all[i].surface.geometric);
        dvec3 n = glm::normalize(turned(all[i]));
        if (dot(2.0 * dot(wo, n) * n - wo, geometric) <= 0.0) {
            n = geometric;
            ++fallen;
        }
        const dvec3 expected = 2.0 * dot(wo, n) * n - wo;
        if (std::abs(dot(expected, geometric)) < 1e-5) {
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

TEST_F(ScatterPathTest, GlassTakesTheShadingNormalsSide)
{
    const std::vector<Case> all = cases(5000, 2, 1, 0.9);
    const std::vector<Result> results = run(test(), all);
    std::size_t passed = 0, behind = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const dvec3 wo = -dvec3(all[i].ray.direction), wi(results[i].ray.direction);
        const bool isBehind = dot(wo, dvec3(all[i].surface.shading)) < 0.0;
        const dvec3 n = glm::normalize(isBehind ? -dvec3(all[i].surface.shading) : dvec3(all[i].surface.shading));
        const double eta = (all[i].surface.front != 0) != isBehind ? kIndex : 1.0 / kIndex;
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

TEST_F(ScatterPathTest, RouletteKeepsTheMean)
{
    const std::vector<Case> all = cases(20000, 1, 1, 0.0);
    KernelTest fixed = test();
    fixed.specialize(kSpecRoulette, kRouletteFixed);
    fixed.pass().survival = 0.25F;
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

// What sampling lights has found already, the last ray need not; nothing else can find what a mirror shows.
TEST_F(ScatterPathTest, TheLastRayIsTracedOnlyForWhatItAloneFinds)
{
    for (const uint material : {0U, 1U, 2U}) {
        for (const uint direct : {kDirectMis, kDirectLights, kDirectHemisphere, kDirectBsdf}) {
            for (const uint maxBounces : {2U, 3U}) {
                KernelTest last = test();
                last.specialize(kSpecDirect, direct);
                last.pass().maxBounces = maxBounces;
                const bool none = kOf[material] == kLambert && maxBounces == 2 && (direct == kDirectLights || direct == kDirectHemisphere);
                const std::vector<Result> results = run(std::move(last), cases(100, material, 1, 0.0));
                EXPECT_EQ(std::ranges::count(results, 1U, &Result::alive), none ? 0 : 100) << material << ", " << direct << ", " << maxBounces;
            }
        }
    }
}

}  // namespace
}  // namespace glim
