// Which light is chosen for a point: probabilities, their sum, how well they follow what arrives, and the cases in which other renderers'
// trees went wrong.
#include "shaders/shared/bindings.h"
#include "shaders/shared/guide_types.h"
#include "test_kernels.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>

namespace glim::light_choice_test {

using glm::dvec3;
using glm::vec3;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kDraws = 1U << 17;
constexpr std::size_t kFamily = 60;

struct Receiver {
    vec3 p;
    vec3 receiverNormal;  // 0: light from all sides counts
    std::uint32_t sight = 0;
};

struct Result {
    uint light;
    float probability;
    uint primitive;
    vec3 wi;
    uint lit;
};

std::vector<Result> draw(const SceneOnDevice& scene, const std::vector<Receiver>& receivers)
{
    KernelTest test = scene.test(test_kernels::light_choice_test);
    test.specialize(kSpecGuided, receivers.front().sight != 0 ? 1 : 0);
    const auto threads = static_cast<std::uint32_t>(receivers.size()) * kDraws;
    test.pass().sampleCount = kDraws;
    test.cases(receivers).resultsOf<Result>(threads).threads(threads).run();
    return test.results<Result>();
}

// Of every light, for each receiver.
std::vector<std::vector<double>> probabilities(const SceneOnDevice& scene, const std::vector<Receiver>& receivers)
{
    const auto lights = static_cast<std::uint32_t>(scene.flat.lights.size());
    std::vector<std::vector<double>> found;
    for (const Receiver& receiver : receivers) {
        KernelTest test = scene.test(test_kernels::light_probability_test);
        test.specialize(kSpecGuided, receiver.sight != 0 ? 1 : 0);
        test.cases(std::vector<Receiver>{receiver}).resultsOf<float>(lights).threads(lights).run();
        const std::vector<float> row = test.results<float>();
        found.emplace_back(row.begin(), row.end());
    }
    return found;
}

double sumOf(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values) {
        sum += value;
    }
    return sum;
}

// Probabilities add up to that of sampling a light at all, are positive, and are those that lights are drawn with.
void expectDistribution(const std::string& name, const Scene& scene, const std::vector<Receiver>& receivers)
{
    const SceneOnDevice onDevice(scene);
    const std::vector<std::vector<double>> expected = probabilities(onDevice, receivers);
    const std::vector<Result> drawn = draw(onDevice, receivers);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const std::string what = name + ", receiver " + std::to_string(r);
        const double sampled = static_cast<double>(lightSampleShare(receivers[r].sight));
        EXPECT_NEAR(sumOf(expected[r]), sampled, 1e-5) << what;
        EXPECT_GT(*std::ranges::min_element(expected[r]), 0.0) << what;
        std::vector<double> counts(expected[r].size() + 1, 0.0), shares = expected[r];  // the last one: of no light
        for (std::size_t i = 0; i < kDraws; ++i) {
            counts[std::min<std::size_t>(drawn[r * kDraws + i].light, expected[r].size())] += 1.0;
        }
        for (double& share : shares) {
            share *= sampled * kDraws / sumOf(expected[r]);
        }
        shares.push_back((1.0 - sampled) * kDraws);
        if (sampled == 1.0) {
            EXPECT_EQ(counts.back(), 0.0) << what;
            counts.pop_back();
            shares.pop_back();
        }
        expectCounts(what, counts, shares, kFamily);
    }
}

const std::vector<Receiver> kReceivers = {{vec3(0.0F), {0, 1, 0}},
                                          {vec3(0.1F, -0.9F, 0.2F), vec3(0.0F)},
                                          {vec3(40, 3, -20), {0.6F, 0, 0.8F}},
                                          {vec3(0.2F, 0.999F, 0.1F), {0, -1, 0}}};

// Lights of every kind, at random places of [-1, 1]^3. Some are two-sided, spots are narrow and wide.
Scene randomLights(std::uint32_t count)
{
    std::mt19937 random(count);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    const auto any = [&] { return vec3(uniform(random), uniform(random), uniform(random)); };
    SceneBuilder builder;
    for (std::uint32_t i = 0; i < count; ++i) {
        const vec3 at = any(), side = 0.1F * any(), direction = glm::normalize(any());
        const vec3 strength(std::exp(2.0F * uniform(random)));
        const std::uint32_t kind = i % 5;
        if (kind < 2) {
            builder.polygon({at, at + side, at + glm::cross(side, direction)}, builder.lambert(vec3(0.0F), strength, kind == 1));
        } else if (kind == 2) {
            builder.sphere(at, 0.05F, builder.lambert(vec3(0.0F), strength));
        } else if (kind == 3) {
            builder.light({"", PunctualLight::Kind::Point, at, {0, 0, -1}, 0.01F * strength});
        } else {
            const float outer = std::abs(uniform(random));
            builder.light({"", PunctualLight::Kind::Spot, at, direction, 0.01F * strength, 0.5F * outer, outer});
        }
    }
    return builder.scene();
}

TEST(LightChoiceTest, DrawsWithTheProbabilitiesThatItStates)
{
    for (const std::uint32_t count : {2U, 5U, 16U, 17U, 200U}) {
        expectDistribution(std::to_string(count) + " lights", randomLights(count), kReceivers);
    }
}

// What a guide knows of lights: those that are seldom seen are chosen less often, and where light samples bring little there are fewer.
TEST(LightChoiceTest, AGuidesSightChangesProbabilities)
{
    std::mt19937 random(9);
    std::vector<Receiver> receivers = kReceivers;
    for (Receiver& receiver : receivers) {
        receiver.sight = std::max(1U, static_cast<std::uint32_t>(random()));
    }
    for (const std::uint32_t count : {2U, 17U, 200U}) {
        expectDistribution(std::to_string(count) + " lights by sight", randomLights(count), receivers);
    }
    SceneBuilder builder;
    for (const float x : {-1.0F, 2.0F}) {
        builder.quad({vec3(x, 2, -1), {x + 1, 2, -1}, {x + 1, 2, 1}, {x, 2, 1}}, builder.lambert(vec3(0.0F), vec3(1.0F)));
    }
    const SceneOnDevice two(builder.environment(vec3(0.25F)).scene());
    const auto with = [&](std::uint32_t sight) { return probabilities(two, {{kReceivers[0].p, kReceivers[0].receiverNormal, sight}})[0]; };
    const std::vector<double> plain = with(0), first = with(2), finite = with(2U << (3 * kSightOfFinite)),
                              infinite = with(2U << (3 * kSightOfInfinite)), rarer = with(2U << 30U);
    ASSERT_EQ(plain.size(), 3U);
    // Half the importance, of what does not ignore it.
    const auto byImportance = [](double p, const std::vector<double>& all) {
        return p / (all[0] + all[1]) - 0.5 * static_cast<double>(kUniformShare);
    };
    const double oddsOfFirst = byImportance(first[0], first) / byImportance(first[1], first);
    const double odds = byImportance(plain[0], plain) / byImportance(plain[1], plain);
    EXPECT_TRUE(std::abs(oddsOfFirst / odds - 0.5) < 1e-5 || std::abs(oddsOfFirst / odds - 2.0) < 1e-5)
        << "the tree has an order of its own";
    const auto oddsOfInfinite = [](const std::vector<double>& p) { return (p[2] - 0.1) / (p[0] + p[1] - 0.1); };
    EXPECT_NEAR(oddsOfInfinite(finite) / oddsOfInfinite(plain), 2.0, 1e-5);
    EXPECT_NEAR(oddsOfInfinite(infinite) / oddsOfInfinite(plain), 0.5, 1e-5);
    KernelTest learning = two.test(test_kernels::light_probability_test);
    learning.specialize(kSpecGuided, 1).specialize(kSpecLearns, 1);
    learning.cases(std::vector<Receiver>{{kReceivers[0].p, kReceivers[0].receiverNormal, 2U << 30U}}).resultsOf<float>(3).threads(3).run();
    const std::vector<float> always = learning.results<float>();
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(rarer[i], 0.25 * plain[i], 1e-7);
        EXPECT_NEAR(static_cast<double>(always[i]), plain[i], 1e-7) << "paths that learn";
    }
}

// Suns, an environment and finite lights: groups count by what arrives, and so do the infinite ones among each other.
TEST(LightChoiceTest, SunsAndEnvironmentsAreSiblingsOfTheTree)
{
    SceneBuilder builder;
    builder.quad({vec3(-1, 2, -1), {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, builder.lambert(vec3(0.0F), vec3(1.0F)))
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0, -1, 0}, vec3(1.0F)})
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0, -1, 0}, vec3(3.0F)})
        .environment(vec3(0.25F));
    expectDistribution("suns", builder.scene(), kReceivers);
    const std::vector<double> p = probabilities(SceneOnDevice(builder.scene()), {kReceivers[0]})[0];
    // Of a constant environment pi L arrives. The lamp is seen within its bounding sphere of sqrt(2) m, 2 m away: 45 degrees wide, so that
    // its cosines count as 1.
    const std::vector<double> irradiances = {1.0, 3.0, 0.25 * kPi};
    const double infinite = 4.0 + 0.25 * kPi, lamp = 4.0 / 4.0, share = 0.1 + 0.8 * lamp / (lamp + infinite);
    ASSERT_EQ(p.size(), 4U);
    EXPECT_NEAR(p[0], share, 1e-6);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(p[i + 1], (1.0 - share) * irradiances[i] / infinite, 1e-6);
    }
}

// H14: a million lights, of which one is brighter than all others together; each has at least its part of the uniform share.
TEST(LightChoiceTest, H14AMillionLights)
{
    constexpr int kCount = 1000000;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    Triangles triangles(kCount);
    for (Triangle& triangle : triangles) {
        const vec3 at(uniform(random), uniform(random), uniform(random));
        triangle = {{at, at + vec3(1e-3F, 0, 0), at + vec3(0, 1e-3F * (1.5F + uniform(random)), 1e-3F)}};
    }
    triangles[0] = {{vec3(0, 0.9F, 0), vec3(100, 0.9F, 0), vec3(0, 0.9F, 100)}};
    Scene scene = makeTestScene({}, {});
    scene.materials.resize(2);
    scene.materials[1].emission = vec3(1.0F);
    addMesh(scene, triangles, 1);
    const Primitives primitives = makePrimitives(scene);
    const auto begin = std::chrono::steady_clock::now();
    const SceneOnDevice onDevice(scene, primitives);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ASSERT_EQ(onDevice.flat.finiteLights, static_cast<std::uint32_t>(kCount));
    double sum = 0.0, error = 0.0;
    for (const std::vector<double>& p : probabilities(onDevice, {kReceivers[0], kReceivers[1]})) {
        EXPECT_GE(*std::ranges::min_element(p), static_cast<double>(kUniformShare) / kCount * (1.0 - 1e-6));
        sum = sumOf(p);
        error = std::max(error, std::abs(sum - 1.0));
    }
    EXPECT_LE(error, 1e-5);
    printHardCase("H14", "a million lights, one of them bright", kCount, "probabilities add up to 1 within " + figure(error),
                  "scene and trees in " + figure(seconds) + " s");
}

// The unit of length does not matter.
TEST(LightChoiceTest, IsTheSameAtEveryScale)
{
    for (const std::uint32_t count : {10U, 100U}) {
        const Scene scene = randomLights(count);
        const std::vector<std::vector<double>> plain = probabilities(SceneOnDevice(scene), kReceivers);
        for (const float scale : {1e-3F, 1e3F}) {
            Scene scaled = scene;
            for (Mesh& mesh : scaled.meshes.change()) {
                for (auto& position : mesh.positions) {
                    position *= static_cast<double>(scale);
                }
            }
            for (Sphere& sphere : scaled.spheres) {
                sphere.center *= scale;
                sphere.radius *= scale;
            }
            for (PunctualLight& light : scaled.lights) {
                light.position *= static_cast<double>(scale);
                light.intensity *= scale * scale;  // surfaces grow by this
            }
            std::vector<Receiver> receivers = kReceivers;
            for (Receiver& receiver : receivers) {
                receiver.p *= scale;
            }
            const std::vector<std::vector<double>> found = probabilities(SceneOnDevice(scaled), receivers);
            for (std::size_t r = 0; r < receivers.size(); ++r) {
                for (std::size_t i = 0; i < found[r].size(); ++i) {
                    EXPECT_NEAR(found[r][i], plain[r][i], 1e-4 * plain[r][i]) << count << " lights, scale " << scale;
                }
            }
        }
    }
}

// Relative variance of one light's exact contribution, from lights that are small against their distance, on a matt surface. `power`: if
// lights are chosen by power instead.
struct Variances {
    double tree, power;
};

Variances variancesOf(const std::vector<dvec3>& places, const std::vector<dvec3>& normals, const std::vector<double>& powers,
                      const Receiver& receiver, const std::vector<double>& probabilities)
{
    double sum = 0.0, byTree = 0.0, byPower = 0.0;
    const double power = sumOf(powers);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const dvec3 towards = places[i] - dvec3(receiver.p);
        const double d2 = glm::dot(towards, towards);
        const double received = std::max(0.0, glm::dot(towards, dvec3(receiver.receiverNormal))) / std::sqrt(d2);
        const double c = powers[i] * std::max(0.0, -glm::dot(normals[i], towards)) / std::sqrt(d2) * received / d2;
        sum += c;
        byTree += c * c / probabilities[i];
        byPower += c * c / (powers[i] / power);
    }
    return {byTree / (sum * sum) - 1.0, byPower / (sum * sum) - 1.0};
}

double computeMedian(std::vector<double> values)
{
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

struct Field {
    const char* name;
    vec3 extent;   // half of it
    double sigma;  // of the logarithm of powers
    double gain;   // at least, over choosing by power
    std::uint32_t count = 1U << 17;
    bool hidden = false;  // the first light has ten times the power of all others, and nothing of it arrives
};

// Small triangles with random normals, in a room and over a wide, flat city; median over receivers.
TEST(LightChoiceTest, FollowsWhatArrivesBetterThanPower)
{
    for (const Field& field : {Field{"room", vec3(1.0F), 2.0, 2.5}, Field{"city", {50, 1, 50}, 1.0, 4.0},
                               Field{"a hidden lamp", vec3(1.0F), 0.0, 2.0, 1024, true}}) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
        std::normal_distribution<float> normal;
        Scene scene = makeTestScene({}, {});
        constexpr std::uint32_t kShades = 64;
        std::vector<Triangles> byShade(kShades);
        for (std::uint32_t i = 0; i < field.count; ++i) {
            const vec3 at = field.extent * vec3(uniform(random), uniform(random), uniform(random));
            const vec3 a = glm::normalize(vec3(normal(random), normal(random), normal(random)));
            const vec3 b = glm::normalize(glm::cross(a, vec3(normal(random), normal(random), normal(random))));
            byShade[random() % kShades].push_back({{at, at + 1e-4F * a, at + 1e-4F * b}});
        }
        for (Triangles& triangles : byShade) {
            scene.materials.emplace_back();
            scene.materials.back().emission = vec3(std::exp(static_cast<float>(field.sigma) * normal(random)));
            addMesh(scene, triangles, static_cast<std::uint32_t>(scene.materials.size()) - 1);
        }
        if (field.hidden) {
            scene.materials.emplace_back();
            scene.materials.back().emission = vec3(10.0F * static_cast<float>(field.count));
            addMesh(scene, {{{vec3(0, 0.9F, 0), vec3(1e-4F, 0.9F, 0), vec3(0, 0.9F, 1e-4F)}}}, kShades);
        }
        const SceneOnDevice onDevice(scene);
        std::vector<dvec3> places, normals;
        std::vector<double> powers;
        for (const FlatLight& light : onDevice.flat.lights) {
            places.push_back(dvec3(light.position) + (dvec3(light.edge1) + dvec3(light.edge2)) / 3.0);
            normals.push_back(glm::normalize(glm::cross(dvec3(light.edge1), dvec3(light.edge2))));
            powers.push_back(static_cast<double>(light.size) * static_cast<double>(light.intensity.r));
            normals.back() *= field.hidden && light.intensity.r > 1000.0F ? 0.0 : 1.0;
        }
        std::vector<Receiver> receivers;
        for (int i = 0; i < 9; ++i) {
            receivers.push_back({field.extent * vec3(uniform(random), -1.0F, uniform(random)), {0, 1, 0}});
        }
        std::vector<double> tree, power;
        const std::vector<std::vector<double>> found = probabilities(onDevice, receivers);
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            const Variances variances = variancesOf(places, normals, powers, receivers[r], found[r]);
            tree.push_back(variances.tree);
            power.push_back(variances.power);
        }
        printHardCase("H14", std::string(field.name) + ": relative variance of one choice", field.count, figure(computeMedian(tree)),
                      "by power: " + figure(computeMedian(power)));
        EXPECT_GT(computeMedian(power), field.gain * computeMedian(tree)) << field.name;
    }
}

// A ball of 1,280 triangles of 5 cm radius at (0, 2, 0), of which every other one in x is half as bright; and a lamp beside it.
Scene bulb(bool twoSided)
{
    Scene scene = makeTestScene({}, {});
    scene.materials.resize(3);
    Triangles shades[2];
    for (Triangle triangle : icosphere(3)) {
        const bool dim = triangle.vertices[0].x > 0.0F;
        for (vec3& vertex : triangle.vertices) {
            vertex = 0.05F * vertex + vec3(0, 2, 0);
        }
        shades[dim ? 1 : 0].push_back(triangle);
    }
    for (std::uint32_t i = 0; i < 2; ++i) {
        scene.materials[i + 1].emission = vec3(i == 0 ? 2.0F : 1.0F);
        scene.materials[i + 1].doubleSided = twoSided;
        addMesh(scene, shades[i], i + 1);
    }
    addMesh(scene, {{{vec3(-3, 0, -3), vec3(-3, 0, 3), vec3(3, 0, 3)}}});
    scene.lights.push_back({"", PunctualLight::Kind::Point, {1, 2, 0}, {0, 0, -1}, vec3(1e-4F)});
    return scene;
}

// From afar the way down the tree ends at the bulb; from near at parts of it, or not before its lights; along an axis two sides have no
// part.
TEST(LightChoiceTest, ALampOfManyTrianglesCostsAsOne)
{
    const std::vector<Receiver> receivers = {{{0, 0, 0}, {0, 1, 0}},      {{0.7F, 0.4F, 1.1F}, {0, 1, 0}},  {{-1, 2, 0}, {1, 0, 0}},
                                             {{-3, 3, -2}, vec3(0.0F)},   {{0.1F, 1.9F, 0.1F}, {0, 1, 0}},  {{0, 1.7F, 0.02F}, {0, 1, 0}},
                                             {{0, 2, 0.01F}, vec3(0.0F)}, {{1e6F, 2e6F, -1e6F}, {0, -1, 0}}};
    for (const bool twoSided : {false, true}) {
        const Scene scene = bulb(twoSided);
        EXPECT_TRUE((SceneOnDevice(scene).flat.features & kFeatureLightClusters) != 0);
        expectDistribution(twoSided ? "two-sided bulb" : "bulb", scene, receivers);
    }
    EXPECT_TRUE((SceneOnDevice(randomLights(200)).flat.features & kFeatureLightClusters) == 0) << "nowhere small, but code for them";
}

// By its power towards the point. By power alone a ball has 5 / 3: half of its triangles face away.
TEST(LightChoiceTest, ALampOfManyTrianglesIsChosenByItsSideTowardsThePoint)
{
    const SceneOnDevice onDevice(bulb(false));
    std::vector<dvec3> places, normals;
    std::vector<double> powers;
    for (const FlatLight& light : onDevice.flat.lights) {
        const bool isTriangle = light.kind == kTriangleLight;
        places.push_back(dvec3(light.position) + (isTriangle ? (dvec3(light.edge1) + dvec3(light.edge2)) / 3.0 : dvec3(0.0)));
        normals.push_back(isTriangle ? glm::normalize(glm::cross(dvec3(light.edge1), dvec3(light.edge2))) : dvec3(0.0));
        powers.push_back(isTriangle ? static_cast<double>(light.size) * static_cast<double>(light.intensity.r) : 1e-9);
    }
    const std::vector<Receiver> receivers = {{{0, 0, 0}, {0, 1, 0}}, {{0.7F, 0.4F, 1.1F}, {0, 1, 0}}, {{-2, 0, 2}, {0, 1, 0}}};
    const std::vector<std::vector<double>> found = probabilities(onDevice, receivers);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
        const Variances variances = variancesOf(places, normals, powers, receivers[r], found[r]);
        printHardCase("H14", "a bulb: relative variance of one choice", 1280, figure(variances.tree),
                      "by power: " + figure(variances.power));
        EXPECT_GT(variances.power, 1.5 * variances.tree);
    }
}

// What went wrong in the trees of Cycles and pbrt-v4, one case each; each would give a probability that is not finite or adds up wrongly.
struct Trap {
    const char* name;
    Scene scene;
    std::vector<Receiver> receivers;
};

// `count` copies of a light, so that there is a tree.
Scene copies(std::uint32_t count, const std::function<void(SceneBuilder&, std::uint32_t)>& add)
{
    SceneBuilder builder;
    builder.sphere({0, -50, 0}, 0.1F, builder.lambert(vec3(0.5F)));  // the BVH must hold something
    for (std::uint32_t i = 0; i < count; ++i) {
        add(builder, i);
    }
    return builder.scene();
}

void addTriangle(SceneBuilder& builder, const vec3& at, bool up, float size = 0.1F)
{
    const vec3 a = at + vec3(size, 0, 0), b = at + vec3(0, 0, size);
    builder.polygon(up ? std::vector<vec3>{at, b, a} : std::vector<vec3>{at, a, b}, builder.lambert(vec3(0.0F), vec3(1.0F)));
}

std::vector<Trap> traps()
{
    const auto x = [](std::uint32_t i) { return static_cast<float>(i); };
    return {
        {"normals that cancel",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i / 2), 0, 0}, i % 2 == 0);
                }),
         {{{3, 1, 0}, {0, -1, 0}}, {{3, -1, 0}, {0, 1, 0}}}},
        {"within a node",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i), 0, 0}, true);
                }),
         {{{16, 0, 0}, {0, 1, 0}}}},
        {"far away",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i), 0, 0}, true);
                }),
         {{{1e7F, 1e7F, 0}, {0, -1, 0}}, {{0, 1e12F, 0}, {0, -1, 0}}}},
        {"spots of 90 degrees and of .1",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    const float outer = i % 2 == 0 ? 1.0F : 2e-6F;
                    b.light({"", PunctualLight::Kind::Spot, {x(i), 2, 0}, {0, -1, 0}, vec3(1.0F), 0.5F * outer, outer});
                }),
         {{{3, 0, 0}, {0, 1, 0}}, {{3, 4, 0}, {0, -1, 0}}}},
        {"nothing faces the receiver",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i), 1, 0}, true);
                }),
         {{{3, 0, 0}, {0, 1, 0}}, {{3, 0, 0}, {0, -1, 0}}}},
        {"few, and nothing faces the receiver",
         copies(3,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i), 1, 0}, true);
                }),
         {{{3, 0, 0}, {0, 1, 0}}}},
        {"all at one place",
         copies(40,
                [&](SceneBuilder& b, std::uint32_t) {
                    b.light({"", PunctualLight::Kind::Point, vec3(0.0F)});
                }),
         {{{3, 0, 0}, {0, 1, 0}}, {vec3(0.0F), {0, 1, 0}}}},
        {"on the receiver",
         copies(32,
                [&](SceneBuilder& b, std::uint32_t i) {
                    addTriangle(b, {x(i), 0, 0}, true);
                }),
         {{{0.1F, 0, 0}, {0, 1, 0}}, {{5.05F, 0, 0.05F}, {0, 1, 0}}}},
        {"powers from 1e-30 to 1e30",
         copies(61,
                [&](SceneBuilder& b, std::uint32_t i) {
                    b.light({"", PunctualLight::Kind::Point, {x(i), 1, 0}, {0, 0, -1}, vec3(std::pow(10.0F, x(i) - 30.0F))});
                }),
         {{{3, 0, 0}, {0, 1, 0}}, {{-2, 0, 0}, vec3(0.0F)}}},
    };
}

TEST(LightChoiceTest, HasNoneOfTheKnownTraps)
{
    for (const Trap& trap : traps()) {
        expectDistribution(trap.name, trap.scene, trap.receivers);
    }
}

// Deeper than any tree of equal halves: each light is half as far away as the last.
TEST(LightChoiceTest, ALineOfEverNearerLights)
{
    expectDistribution("line",
                       copies(100,
                              [](SceneBuilder& b, std::uint32_t i) {
                                  b.light({"", PunctualLight::Kind::Point, {std::exp2(-static_cast<float>(i)), 0, 0}});
                              }),
                       {{{0, 1, 0}, vec3(0.0F)}, {{1e-6F, 1e-6F, 0}, vec3(0.0F)}});
}

// Two triangles that make a rectangle are one light, wherever they are in the mesh; others are not. Radiance from all of it.
TEST(LightChoiceTest, RectanglesAreFound)
{
    const auto lights = [](const std::vector<Triangle>& triangles) {
        Scene scene = makeTestScene({}, {});
        scene.materials.resize(2);
        scene.materials[1].emission = vec3(1.0F);
        addMesh(scene, triangles, 1);
        return SceneOnDevice(scene).flat;
    };
    const vec3 a(0, 1, 0), b(3, 1, 0), c(3, 1, 2), d(0, 1, 2);
    const Triangle far{{a + 9.0F, b + 9.0F, c + vec3(9, 8, 9)}};
    const FlatScene flat = lights({{{a, b, c}}, far, {{d, a, c}}});
    ASSERT_EQ(flat.lights.size(), 2U);
    EXPECT_EQ(flat.lights[0].kind, kRectangleLight);
    EXPECT_EQ(flat.lights[0].size, 6.0F);
    EXPECT_EQ(std::set<uint>({flat.lights[0].primitive, flat.lights[0].otherPrimitive}), std::set<uint>({0, 2}));
    EXPECT_EQ(lights({{{a, b, c}}, {{a, c, d}}}).lights.size(), 1U);
    EXPECT_EQ(lights({{{a, b, c}}, {{c, d, a}}}).lights.size(), 1U);
    EXPECT_EQ(lights({{{a, b, c}}, {{a, d, c}}}).lights.size(), 2U) << "the other front";
    EXPECT_EQ(lights({{{a, b, c}}, {{a, c, d + vec3(0, 1e-4F, 0)}}}).lights.size(), 2U) << "not flat";
    EXPECT_EQ(lights({{{a, b, c + vec3(1, 0, 0)}}, {{a, c + vec3(1, 0, 0), d + vec3(1, 0, 0)}}}).lights.size(), 2U) << "a parallelogram";
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
        for (const Result& result : draw(scene, {kReceivers[0]})) {
            const dvec3 wi = glm::normalize(dvec3(result.wi));
            const double planar2 = wi.x * wi.x + wi.y * wi.y;
            const double share = planar2 / (1.0 + std::sqrt(1.0 - planar2)) / whole;
            const double turn = (std::atan2(wi.y, wi.x) + kPi) / (2.0 * kPi);
            const int ring = std::clamp(static_cast<int>(16.0 * share), 0, 15);
            counts[16 * ring + std::clamp(static_cast<int>(16.0 * turn), 0, 15)] += 1.0;
        }
        expectCounts("cone of r/d " + std::to_string(ratio), counts, std::vector<double>(256, kDraws / 256.0), kFamily);
    }
}

// One light of each kind, a sphere seen from without and one from within; the kernel compares each sample with that of the same
// light if it is certain.
TEST(LightChoiceTest, CertainLightsLackTheirProbability)
{
    SceneBuilder builder;
    builder.quad({vec3(-1, 2, -1), {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, builder.lambert(vec3(0.0F), vec3(1.0F), true))
        .polygon({vec3(-1, 3, -1), {1, 3, -1}, {1, 3, 1}}, builder.lambert(vec3(0.0F), vec3(1.0F), true))
        .sphere({3, 1, 0}, 0.5F, builder.lambert(vec3(0.0F), vec3(2.0F)))
        .sphere({0, 0, 1}, 5.0F, builder.lambert(vec3(0.0F), vec3(0.1F), true))
        .light({"", PunctualLight::Kind::Point, {0, 0.9F, 0}, {0, 0, -1}, vec3(3.0F, 7.0F, 0.0F)})
        .light({"", PunctualLight::Kind::Spot, {0, 0.9F, 0}, {0, -1, 0}, vec3(90.0F), 0.1F, 0.5F})
        .light({"", PunctualLight::Kind::Directional, {0, 0, 0}, {0, -1, 0}, vec3(1.5F)})
        .environment(vec3(0.2F));
    const SceneOnDevice scene(builder.scene());
    ASSERT_EQ(scene.flat.lights.size(), 8U);
    std::vector<std::uint32_t> lit(8, 0);
    for (const Result& result : draw(scene, {kReceivers[0]})) {
        lit[result.light] += result.lit;
        EXPECT_LT(result.probability, 0.95F);
    }
    for (std::size_t i = 0; i < lit.size(); ++i) {
        EXPECT_GT(lit[i], 200U) << "light " << i;
    }
}

}  // namespace glim::light_choice_test
