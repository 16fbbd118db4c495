// Light paths begin with the power that their lamp sends to the targets, and lamps are chosen by that power.
#include "host/flatten/environment_map.hpp"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/irradiance_formulas.hpp"
#include "tests/support/named.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace glim::light_path_test {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kPaths = 1U << 18;
constexpr std::size_t kFamily = 80;  // comparisons

struct Result {
    PathRay ray;
    vec3 flux;
    float range;
    uint light;
    float probability;
};

std::vector<Result> begin(const SceneOnDevice& scene, const std::vector<uint>& words)
{
    EXPECT_NE(scene.flat.features & kFeatureCaustics, 0U);
    KernelTest test = scene.test(test_kernels::light_path_test);
    test.parameters().environment = scene.flat.environment;
    test.parameters().environmentSize = scene.flat.environmentMap->size;
    test.parameters().environmentCells = scene.flat.environmentMap->cellCount;
    test.parameters().environmentRotation = scene.flat.environmentRotation;
    test.parameters().environmentSplit = scene.flat.environmentMap->split;
    test.parameters().brightCells = static_cast<uint>(scene.flat.environmentMap->brightCells.size());
    test.parameters().causticTargets = scene.flat.causticTargets;
    test.parameters().causticLights = scene.flat.causticLights;
    test.parameters().lightPaths = static_cast<uint>(words.size());
    test.specialize(kSpecSobol, 0).cases(words).resultsOf<Result>(words.size()).run();
    return test.results<Result>();
}

struct Ball {
    dvec3 center;
    double radius;
};

bool meets(const PathRay& ray, const Ball& ball)
{
    const dvec3 towards = ball.center - dvec3(ray.origin), direction = glm::normalize(dvec3(ray.direction));
    const double along = glm::dot(towards, direction);
    const double inside = ball.radius * ball.radius - glm::dot(towards, towards);
    return inside >= 0.0 || (along > 0.0 && glm::length(glm::cross(towards, direction)) <= ball.radius);
}

// Power that a patch of radiance 1 sends into the ball, per area.
double powerOfPatch(const dvec3& p, const dvec3& n, const Ball& ball)
{
    const dvec3 towards = ball.center - p;
    return glm::length(towards) <= ball.radius ? kPi : computeSphereIrradiance(towards, ball.radius, n);
}

// The same from a parallelogram's points p + x a + y b with x, y in [0, 1), or the half of it with x + y < 1.
double powerOfPolygon(const dvec3& p, const dvec3& a, const dvec3& b, bool half, const Ball& ball)
{
    constexpr int kSteps = 400;
    const dvec3 normal = glm::cross(a, b), n = glm::normalize(normal);
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double x = (i + 0.5) / kSteps, y = (j + 0.5) / kSteps;
            const double share = !half || x + y < 1.0 - 1e-9 ? 1.0 : x + y < 1.0 + 1e-9 ? 0.5 : 0.0;
            sum += share > 0.0 ? share * powerOfPatch(p + x * a + y * b, n, ball) : 0.0;
        }
    }
    return sum * glm::length(normal) / (kSteps * kSteps);
}

// The same from the outside of a sphere. Archimedes: rings of equal height have equal areas.
double powerOfSphere(const Ball& lamp, const Ball& ball)
{
    constexpr int kSteps = 600;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double z = 2.0 * (i + 0.5) / kSteps - 1.0, phi = 2.0 * kPi * (j + 0.5) / kSteps, r = std::sqrt(1.0 - z * z);
            const dvec3 n(r * std::cos(phi), r * std::sin(phi), z);
            sum += powerOfPatch(lamp.center + lamp.radius * n, n, ball);
        }
    }
    return sum * 4.0 * kPi * lamp.radius * lamp.radius / (kSteps * kSteps);
}

// Power of a point light or spot: its intensity over the ball's cone, in rings and sectors of equal solid angle.
double powerOfPoint(const PunctualLight& light, const Ball& ball)
{
    const dvec3 towards = ball.center - dvec3(light.position);
    const double whole = 1.0 - std::sqrt(1.0 - std::pow(ball.radius / glm::length(towards), 2.0));
    const dvec3 z = glm::normalize(towards), x = glm::normalize(glm::cross(z, dvec3(0.3, 0.9, -0.2))), y = glm::cross(z, x);
    constexpr int kSteps = 1500;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double rise = whole * (i + 0.5) / kSteps, phi = 2.0 * kPi * (j + 0.5) / kSteps, r = std::sqrt(rise * (2.0 - rise));
            const dvec3 w = (1.0 - rise) * z + r * (std::cos(phi) * x + std::sin(phi) * y);
            const double versine = 1.0 - glm::dot(w, dvec3(light.direction)), outer = static_cast<double>(light.versineOuter);
            const double ramp = std::clamp((outer - versine) / (outer - static_cast<double>(light.versineInner)), 0.0, 1.0);
            sum += light.kind == PunctualLight::Kind::Point ? 1.0 : ramp * ramp;
        }
    }
    return static_cast<double>(light.intensity.r) * sum * 2.0 * kPi * whole / (kSteps * kSteps);
}

// What shines, and the power that it sends into a ball that nothing hides.
struct Lamp {
    std::function<void(SceneBuilder&)> add;
    std::function<double(const Ball&)> power;
};

constexpr float kRadiance = 3.0F;
constexpr double kL = 3.0;

Lamp polygonLamp(bool rectangle, bool twoSided)
{
    const vec3 p(-0.5F, 1.0F, -0.4F), a = 0.6F * vec3(1, 0.5F, 0), b = rectangle ? 0.9F * vec3(-0.5F, 1, 0) : vec3(0.2F, 0.1F, 0.7F);
    return {[=](SceneBuilder& builder) {
                const auto light = builder.lambert(vec3(0.0F), vec3(kRadiance), twoSided);
                rectangle ? builder.quad({p, p + a, p + a + b, p + b}, light) : builder.polygon({p, p + a, p + b}, light);
            },
            [=](const Ball& ball) {
                const dvec3 corner(p), one(a), other(b);
                const double front = powerOfPolygon(corner, one, other, !rectangle, ball);
                return kL * (front + (twoSided ? powerOfPolygon(corner, other, one, !rectangle, ball) : 0.0));
            }};
}

Lamp sphereLamp()
{
    const Ball lamp{{0.3, 1.6, 0.2}, 0.25};
    return {[lamp](SceneBuilder& builder) {
                builder.sphere(vec3(lamp.center), static_cast<float>(lamp.radius), builder.lambert(vec3(0.0F), vec3(kRadiance)));
            },
            [lamp](const Ball& ball) { return kL * powerOfSphere(lamp, ball); }};
}

Lamp punctualLamp(const PunctualLight& light)
{
    return {[light](SceneBuilder& builder) { builder.light(light); },
            [light](const Ball& ball) {
                const bool directional = light.kind == PunctualLight::Kind::Directional;
                return directional ? static_cast<double>(light.intensity.r) * kPi * ball.radius * ball.radius : powerOfPoint(light, ball);
            }};
}

Lamp spotLamp(float inner, float outer)
{
    return punctualLamp(
        {"", PunctualLight::Kind::Spot, {0.2F, 1.5F, 0.3F}, glm::normalize(vec3(-0.3F, -1, -0.2F)), vec3(5.0F), inner, outer});
}

Lamp pointLamp() { return punctualLamp({"", PunctualLight::Kind::Point, {0.5F, 1.2F, 0.3F}, {0, 0, -1}, vec3(3.0F)}); }

Lamp sunLamp()
{
    return punctualLamp({"", PunctualLight::Kind::Directional, {0, 0, 0}, glm::normalize(vec3(-0.7F, -0.6F, 0.1F)), vec3(3.0F)});
}

// The bright part of a map: what exceeds the split in the strongest channel. Over its bilinear interpolant, in fine steps.
Lamp sunOfMap()
{
    constexpr std::uint32_t kWidth = 64, kHeight = 32;
    const auto map = std::make_shared<RadianceMap>(RadianceMap{kWidth, kHeight, std::vector<vec3>(kWidth * kHeight, vec3(0.1F)), 0});
    map->texels[9 * kWidth + 63] = map->texels[21 * kWidth + 30] = vec3(300.0F);
    map->texels[21 * kWidth + 31] = vec3(100.0F);
    const double split = static_cast<double>(packEnvironmentMap(map).split);
    double irradiance = 0.0;
    constexpr int kSteps = 20;  // to a texel
    for (std::uint32_t y = 0; y < kHeight * kSteps; ++y) {
        const double v = (y + 0.5) / kSteps - 0.5,
                     omega = 2.0 * kPi * kPi / (kWidth * kHeight * kSteps * kSteps) * std::sin(kPi * (y + 0.5) / (kHeight * kSteps));
        for (std::uint32_t x = 0; x < kWidth * kSteps; ++x) {
            const double u = (x + 0.5) / kSteps - 0.5;
            double radiance = 0.0;
            for (int k = 0; k < 4; ++k) {
                const double i = std::floor(u) + k % 2, j = std::floor(v) + k / 2;
                const auto row = static_cast<std::size_t>(std::clamp(j, 0.0, kHeight - 1.0)),
                           column = static_cast<std::size_t>(i + kWidth) % kWidth;
                radiance += (1.0 - std::abs(u - i)) * (1.0 - std::abs(v - j)) * static_cast<double>(map->texels[row * kWidth + column].r);
            }
            irradiance += omega * std::max(0.0, radiance - split);
        }
    }
    return {[map](SceneBuilder& builder) {
                builder.environment(Environment{vec3(2.0F, 1.0F, 1.0F), map, 0.7F, true, "test"});
            },
            [irradiance](const Ball& ball) { return 2.0 * irradiance * kPi * ball.radius * ball.radius; }};
}

// Two that overlap and one beside the lamps, which the planes of the polygons cut.
const std::vector<Ball> kBalls = {{{0.0, -0.5, 0.0}, 0.5}, {{0.4, -0.3, 0.2}, 0.4}, {{-2.0, 1.3, 0.2}, 0.6}};
// Two that overlap and are small however near one goes: 1/3000 of the distance.
const std::vector<Ball> kFarBalls = {{{40.0, -30.0, 10.0}, 0.015}, {{40.005, -30.0, 10.005}, 0.012}};
// Two that hold some of the lamps.
const std::vector<Ball> kBallsAround = {{{0.3, 1.2, 0.1}, 2.0}, {{0.0, -2.0, 0.0}, 0.7}};

struct Setting {
    std::vector<Lamp> lamps;
    std::vector<Ball> balls = kBalls;
    bool isNarrow = false;
};

SceneBuilder makeTestScene(const Setting& setting)
{
    SceneBuilder builder;
    const auto glass = builder.glass(1.5F);
    for (const Ball& ball : setting.balls) {
        builder.sphere(vec3(ball.center), static_cast<float>(ball.radius), glass);
    }
    for (const Lamp& lamp : setting.lamps) {
        lamp.add(builder);
    }
    return builder;
}

class LightPathTest : public testing::TestWithParam<test::Named<Setting>> {};

TEST_P(LightPathTest, CarryThePowerThatReachesEachTarget)
{
    const Setting& setting = GetParam().value;
    const SceneOnDevice scene(makeTestScene(setting).scene());
    const std::vector<Result> paths = begin(scene, std::vector<uint>(kPaths));
    for (std::size_t i = 0; i < setting.balls.size(); ++i) {
        double power = 0.0;
        for (const Lamp& lamp : setting.lamps) {
            power += lamp.power(setting.balls[i]);
        }
        std::vector<double> values;
        for (const Result& path : paths) {
            values.push_back(path.flux != vec3(0.0F) && meets(path.ray, setting.balls[i]) ? static_cast<double>(path.flux.r) : 0.0);
        }
        expectSampleMean(std::string(GetParam().name) + ", power into ball " + std::to_string(i), values, power, kFamily);
    }
    // None is aimed past the targets, by more than their margin; but for a spot that is narrower than they are.
    for (const Result& path : paths) {
        ASSERT_TRUE(
            path.flux == vec3(0.0F) || setting.isNarrow || std::ranges::any_of(setting.balls, [&path](const Ball& ball) {
                return meets(path.ray, {ball.center, 1.0002 * ball.radius + 3e-7 * glm::distance(ball.center, dvec3(path.ray.origin))});
            }));
    }
}

const test::Named<Setting> kSettings[] = {
    {"triangle", {{polygonLamp(false, false)}}},
    {"twoSidedTriangle", {{polygonLamp(false, true)}}},
    {"rectangle", {{polygonLamp(true, false)}}},
    {"twoSidedRectangle", {{polygonLamp(true, true)}}},
    {"sphere", {{sphereLamp()}}},
    {"point", {{pointLamp()}}},
    {"spot", {{spotLamp(0.05F, 0.3F)}}},
    {"narrowSpot", {{spotLamp(1e-4F, 1e-2F)}, kBalls, true}},
    {"directional", {{sunLamp()}}},
    {"environment", {{sunOfMap()}}},
    {"allOfThem",
     {{polygonLamp(false, true), polygonLamp(true, false), sphereLamp(), pointLamp(), spotLamp(0.05F, 0.3F), sunLamp(), sunOfMap()}}},
    {"trianglesFarAway", {{polygonLamp(false, true)}, kFarBalls}},
    {"pointFarAway", {{pointLamp()}, kFarBalls}},
    {"triangleWithin", {{polygonLamp(false, false)}, kBallsAround}},
    {"sphereWithin", {{sphereLamp()}, kBallsAround}},
};

INSTANTIATE_TEST_SUITE_P(Lamps, LightPathTest, testing::ValuesIn(kSettings), test::nameOfParameter);

// Rays of directional light begin before the whole scene, and those of surfaces on the side that they go to.
TEST(LightPathRayTest, BeginsWhereItsLampIs)
{
    const auto pathsOf = [](const Lamp& lamp) { return begin(SceneOnDevice(makeTestScene({{lamp}}).scene()), std::vector<uint>(4096)); };
    for (const Result& path : pathsOf(sunLamp())) {
        for (const Ball& ball : kBalls) {
            EXPECT_GT(glm::dot(ball.center - dvec3(path.ray.origin), dvec3(path.ray.direction)), ball.radius);
        }
        EXPECT_EQ(path.ray.source, kNoPrimitive);
    }
    bool front = false, back = false;
    const dvec3 corner(-0.5, 1.0, -0.4), n = glm::normalize(glm::cross(dvec3(0.6, 0.3, 0), dvec3(0.2, 0.1, 0.7)));
    for (const Result& path : pathsOf(polygonLamp(false, true))) {
        const double away = glm::dot(n, dvec3(path.ray.origin) - corner), goes = glm::dot(n, dvec3(path.ray.direction));
        EXPECT_TRUE(path.flux == vec3(0.0F) || (away * goes > 0.0 && std::abs(away) < 1e-5)) << away << ", " << goes;
        EXPECT_TRUE(path.flux == vec3(0.0F) || path.ray.source == 0U);
        front = front || goes > 0.0;
        back = back || goes < 0.0;
    }
    EXPECT_TRUE(front && back);
    PunctualLight ranged{"", PunctualLight::Kind::Point, {0.5F, 1.2F, 0.3F}, {0, 0, -1}, vec3(3.0F)};
    ranged.range = 7.0F;
    for (const Result& path : pathsOf(punctualLamp(ranged))) {
        EXPECT_EQ(path.range, 7.0F);
        EXPECT_EQ(path.ray.origin, ranged.position);
    }
}

// Every word chooses the light in whose interval it lies, with the interval's share of all words for its probability.
TEST(LightPathChoiceTest, IsTheTables)
{
    for (const int count : {1, 2, 7, 300}) {
        Random random(static_cast<std::uint64_t>(count));
        SceneBuilder builder;
        builder.sphere(vec3(0.0F), 0.5F, builder.glass(1.5F));
        for (int i = 0; i < count; ++i) {
            const float intensity = static_cast<float>(random.logUniform(1e-9, 1.0));
            builder.light({"", PunctualLight::Kind::Point, 3.0F * vec3(random.direction()), {0, 0, -1}, vec3(intensity)});
        }
        const SceneOnDevice scene(builder.scene());
        ASSERT_EQ(scene.flat.causticLights, static_cast<uint>(count));
        const std::span<const uvec4> table = std::span(scene.flat.caustics).subspan(kFirstCausticLight);
        std::vector<uint> words{0U, 0xffffffffU};
        for (const uvec4& entry : table) {
            words.insert(words.end(), {entry.x, entry.y, entry.x + (entry.y - entry.x) / 2});
        }
        for (int i = 0; i < 2000; ++i) {
            words.push_back(random.bits());
        }
        const std::vector<Result> results = begin(scene, words);
        for (std::size_t i = 0; i < words.size(); ++i) {
            const uvec4& entry = table[results[i].light];
            EXPECT_TRUE(words[i] >= entry.x && words[i] <= entry.y) << words[i] << " chose " << results[i].light;
            const double share = (static_cast<double>(entry.y) - static_cast<double>(entry.x) + 1.0) * 0x1p-32;
            EXPECT_NEAR(static_cast<double>(results[i].probability), share, 2e-7 * share);
        }
    }
}

// Point lights as far from a target send power by their intensities.
TEST(LightPathChoiceTest, IsByPower)
{
    SceneBuilder builder;
    builder.sphere(vec3(0.0F), 0.5F, builder.glass(1.5F))
        .light({"", PunctualLight::Kind::Point, {3, 0, 0}, {0, 0, -1}, vec3(1.0F)})
        .light({"", PunctualLight::Kind::Point, {-3, 0, 0}, {0, 0, -1}, vec3(3.0F)});
    const SceneOnDevice scene(builder.scene());
    double seen = 0.0;
    for (const Result& result : begin(scene, {0U, 0xffffffffU})) {
        const double intensity = static_cast<double>(scene.flat.lights[result.light].intensity.r);
        EXPECT_NEAR(static_cast<double>(result.probability), intensity / 4.0, 1e-6);
        seen += intensity;
    }
    EXPECT_EQ(seen, 4.0);
}

}  // namespace glim::light_path_test
