// Which lights are in which group, and what a film by groups is with other lights.
#include "host/scene/light_groups.hpp"
#include "host/error.hpp"
#include "host/render/regroup.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace glim {
namespace {

using test::expectRefusal;

// Two lights, two materials that emit, one that does not, and an environment.
Scene litScene()
{
    SceneBuilder builder;
    for (const char* name : {"Bulb.001", "Bulb.002"}) {
        builder.light({.name = name, .position = {1, 2, 3}});
    }
    for (const char* name : {"lamp", "screen", "wall"}) {
        Material material = makeLambert(glm::vec3(0.5F), glm::vec3(name == std::string("wall") ? 0.0F : 2.0F));
        material.name = name;
        builder.sphere({0, 0, 0}, 1.0F, builder.add(material));
    }
    builder.environment(glm::vec3(0.5F));
    return builder.scene();
}

std::vector<std::string> namesOf(const std::vector<LightGroup>& groups)
{
    std::vector<std::string> names;
    for (const LightGroup& group : groups) {
        names.push_back(group.name);
    }
    return names;
}

using Names = std::vector<std::string>;

TEST(LightGroups, AreFoundByNamesAndTheirBeginnings)
{
    Scene scene = litScene();
    const auto groups = chooseLightGroups("a.gltf", scene, {{{"bulbs", {"Bulb*"}}, {"sky", {"environment", "screen"}}}, false});
    EXPECT_EQ(namesOf(groups), (Names{"bulbs", "sky", "others"}));
    assignLightGroups(scene, groups);
    EXPECT_EQ(scene.lightGroups, (Names{"bulbs", "sky", "others"}));
    EXPECT_EQ(scene.lights[0].group, 0U);
    EXPECT_EQ(scene.lights[1].group, 0U);
    EXPECT_EQ(scene.materials[0].lightGroup, 2U);
    EXPECT_EQ(scene.materials[1].lightGroup, 1U);
    EXPECT_EQ(scene.environment->group, 1U);
}

TEST(LightGroups, EachIsAGroupForEachLight)
{
    const Scene scene = litScene();
    EXPECT_EQ(namesOf(chooseLightGroups("a.gltf", scene, {{}, true})), (Names{"Bulb_001", "Bulb_002", "lamp", "screen", "environment"}));
    EXPECT_EQ(namesOf(chooseLightGroups("a.gltf", scene, {{{"bulbs", {"Bulb*"}}}, true})),
              (Names{"bulbs", "lamp", "screen", "environment"}));
}

// Names that differ in what a layer's name cannot have are told apart; equal names are one group.
TEST(LightGroups, NamesBecomeThoseOfLayers)
{
    Scene scene = litScene();
    scene.lights[0].name = "key light";
    scene.lights[1].name = "key.light";
    scene.materials[0].name = "others";
    scene.materials[1].name = "key light";
    const auto groups = chooseLightGroups("a.gltf", scene, {{}, true});
    EXPECT_EQ(namesOf(groups), (Names{"key_light", "key_light_2", "others_2", "environment"}));
    assignLightGroups(scene, groups);
    EXPECT_EQ(scene.materials[1].lightGroup, 0U);
}

// What does not emit now may do so at another time.
TEST(LightGroups, MovingScenesHaveOthers)
{
    Scene scene = litScene();
    scene.animations.push_back({"blink", 1.0});
    const auto groups = chooseLightGroups("a.gltf", scene, {{}, true});
    EXPECT_EQ(groups.back().name, "others");
    scene.materials[2].emission = glm::vec3(1.0F);
    assignLightGroups(scene, groups);
    EXPECT_EQ(scene.materials[2].lightGroup, groups.size() - 1);
}

TEST(LightGroups, RefusesWhatItCannotKeepApart)
{
    const Scene scene = litScene();
    const auto choose = [&](const LightGroupChoice& choice) { return [&scene, choice] { chooseLightGroups("a.gltf", scene, choice); }; };
    expectRefusal<InputError>(choose({{{"key", {"Lamp"}}}, false}), MessageId::UnknownName,
                              {.file = "a.gltf", .place = "--light-group", .value = "Lamp"});
    expectRefusal<InputError>(choose({{{"a", {"lamp"}}, {"b", {"la*"}}}, false}), MessageId::Duplicate,
                              {.place = "--light-group", .value = "lamp"});
    Scene many = scene;
    for (int i = 0; i < 6; ++i) {
        many.lights.push_back(many.lights[0]);
        many.lights.back().name = "more" + std::to_string(i);
    }
    expectRefusal<InputError>(
        [&] {
            chooseLightGroups("a.gltf", many, {{}, true});
        },
        MessageId::OutOfRange, {.place = "--light-group", .value = "11 groups", .expected = "at most 8"});
}

constexpr std::uint32_t kGroups = 3, kBlocks = 6;

// One pixel of a film whose blocks have the values `samples`, of groups with the names a, b, c. Blocks are of one sample each.
Film filmOf(const std::vector<std::vector<glm::vec3>>& samples)
{
    Film film;
    film.width = film.height = 1;
    film.identity.settings = "bounces=64 light-groups=a,b,c meshes=shared";
    film.pixels.resize(1);
    film.groups = GroupMoments(kGroups, 1);
    for (const std::vector<glm::vec3>& sample : samples) {
        FilmMoments page;
        page.groups = GroupMoments(kGroups, 1);
        glm::vec3 sum(0.0F);
        for (std::size_t g = 0; g < kGroups; ++g) {
            page.groups.of(0)[g] = sample[g];
            sum += sample[g];
        }
        PixelMoments pixel{};
        pixel.count = pixel.blocks = 1;
        pixel.mean = sum;
        page.pixels = {pixel};
        foldMoments(film, page);
    }
    return film;
}

std::vector<std::vector<glm::vec3>> randomSamples()
{
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0.0F, 4.0F);
    std::vector<std::vector<glm::vec3>> samples(kBlocks);
    for (std::vector<glm::vec3>& sample : samples) {
        for (std::uint32_t g = 0; g < kGroups; ++g) {
            sample.emplace_back(uniform(random), uniform(random), uniform(random));
        }
    }
    return samples;
}

// As if the samples had been weighted before they were added.
TEST(LightGroups, ARegroupedFilmHasMeanAndVarianceOfItsWeightedSamples)
{
    const auto samples = randomSamples();
    const Film film = filmOf(samples);
    const std::vector<glm::vec3> factors{{0.5F, 1.0F, 2.0F}, glm::vec3(0.0F), {3.0F, 0.25F, 1.0F}};
    const Film weighed = regroup(film, factors);
    for (int c = 0; c < 3; ++c) {
        std::vector<double> values;
        double mean = 0.0, squares = 0.0;
        for (const auto& sample : samples) {
            double value = 0.0;
            for (std::size_t g = 0; g < kGroups; ++g) {
                value += static_cast<double>(factors[g][c]) * static_cast<double>(sample[g][c]);
            }
            values.push_back(value);
            mean += value / kBlocks;
        }
        for (const double value : values) {
            squares += (value - mean) * (value - mean);
        }
        EXPECT_NEAR(static_cast<double>(weighed.pixels[0].mean[c]), mean, 1e-5 * mean);
        EXPECT_NEAR(static_cast<double>(computeVarianceOfMean(weighed.pixels[0])[c]), squares / (kBlocks - 1.0) / kBlocks, 1e-4 * squares);
    }
    EXPECT_EQ(weighed.identity.settings, "bounces=64 lights=a:0.5:1:2,b:0,c:3:0.25:1 meshes=shared");
    EXPECT_TRUE(getLightGroups(weighed).empty());
    EXPECT_TRUE(weighed.groups.isEmpty());
}

TEST(LightGroups, OfFactorsOfOneIsTheFilm)
{
    const Film film = filmOf(randomSamples());
    const Film same = regroup(film, std::vector<glm::vec3>(kGroups, glm::vec3(1.0F)));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(same.pixels[0].mean[c], film.pixels[0].mean[c], 2e-6F * film.pixels[0].mean[c]);
        EXPECT_NEAR(same.pixels[0].squares[c], film.pixels[0].squares[c], 2e-5F * film.pixels[0].squares[c]);
    }
    const glm::vec3 ab = computeGroupCovariance(film, 0, 0, 1), ba = computeGroupCovariance(film, 0, 1, 0);
    EXPECT_EQ(ab, ba);
    EXPECT_NEAR(ab.r, film.groups.of(0)[4].r / (kBlocks * (kBlocks - 1.0F)), 1e-6F);
}

TEST(LightGroups, FactorsAreOfGroupsThatTheFilmHas)
{
    const Film film = filmOf(randomSamples());
    const auto factors = factorsOf("a.exr", film, {{"c", glm::vec3(2.0F)}, {"a", {1.0F, 0.0F, 0.5F}}});
    EXPECT_EQ(factors, (std::vector<glm::vec3>{{1.0F, 0.0F, 0.5F}, glm::vec3(1.0F), glm::vec3(2.0F)}));
    expectRefusal<InputError>([&] { factorsOf("a.exr", film, {{"d", {}}}); }, MessageId::UnknownName, {.file = "a.exr", .value = "d"});
    expectRefusal<InputError>([&] { factorsOf("a.exr", Film(), {{"a", {}}}); }, MessageId::UnknownName, {.file = "a.exr"});
}

}  // namespace
}  // namespace glim
