// Back faces of single-sided surfaces are not there, whatever the ray: pictures that are known on paper, and estimators that must agree.
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace glim {
namespace {

constexpr float kAlbedo = 0.5F;

// Corners of a screen in the plane z, its front towards +z or -z.
std::array<glm::vec3, 4> screen(float z, bool forwards)
{
    const std::array<glm::vec3, 4> corners = {glm::vec3(-1, -1, z), {1, -1, z}, {1, 1, z}, {-1, 1, z}};
    return forwards ? corners : std::array{corners[3], corners[2], corners[1], corners[0]};
}

// A screen in a sky of radiance 1, alone in the picture: where it is met it shows its albedo, and else the sky.
SceneBuilder screenInTheSky(bool forwards, const std::function<void(Material&)>& change)
{
    SceneBuilder builder;
    Material material = makeLambert(glm::vec3(kAlbedo));
    change(material);
    builder.quad(screen(0.0F, forwards), builder.add(material));
    builder.environment(glm::vec3(1.0F));
    builder.perspective({0, 0, 3}, {0, 0, 0}, 0.3F);
    return builder;
}

void expectScreen(const Scene& scene, double radiance)
{
    expectEverywhere(renderScene(scene, squareSettings(16, 4)), glm::dvec3(radiance), 2);
}

TEST(Sides, CameraRaysPassBackFaces)
{
    const auto asIs = [](Material&) {};
    const auto doubleSided = [](Material& m) { m.doubleSided = true; };
    expectScreen(screenInTheSky(true, asIs).scene(), 0.5);
    expectScreen(screenInTheSky(true, doubleSided).scene(), 0.5);
    expectScreen(screenInTheSky(false, asIs).scene(), 1.0);
    expectScreen(screenInTheSky(false, doubleSided).scene(), 0.5);
    Scene shown = screenInTheSky(false, asIs).scene();
    shown.showsBackFaces = true;
    expectScreen(shown, 0.5);
}

// Whether the surface needs the test at all.
TEST(Sides, WhatTransmitsHasBackFaces)
{
    const auto isCulled = [](const std::function<void(Material&)>& change) {
        return (flattened(screenInTheSky(false, change).scene()).features & kFeatureSingleSided) != 0;
    };
    EXPECT_TRUE(isCulled([](Material&) {}));
    EXPECT_TRUE(isCulled([](Material& m) { m.emission = glm::vec3(1.0F); }));
    EXPECT_TRUE(isCulled([](Material& m) {
        m.alphaMode = AlphaMode::Blend;
        m.alpha = 0.5F;
    }));
    EXPECT_FALSE(isCulled([](Material& m) { m.doubleSided = true; }));
    EXPECT_FALSE(isCulled([](Material& m) { m.transmission = 0.1F; }));
    EXPECT_FALSE(isCulled([](Material& m) { m.diffuseTransmission = 0.1F; }));
    EXPECT_FALSE(isCulled([](Material& m) { m.thick = true; }));
}

// Half of the sky shows through the front of a screen of alpha .5, and all of it from behind.
TEST(Sides, AlphaIsOfFrontsAlone)
{
    const auto half = [](Material& m) {
        m.alphaMode = AlphaMode::Blend;
        m.alpha = 0.5F;
    };
    expectScreen(screenInTheSky(false, half).scene(), 1.0);
    expectMean("front", renderScene(screenInTheSky(true, half).scene(), squareSettings(32, 64)), glm::dvec3(0.75));
}

// A floor and what is over it, seen from between them.
SceneBuilder floorBelow(const std::function<void(SceneBuilder&)>& add)
{
    SceneBuilder builder;
    builder.quad(screen(0.0F, true), builder.lambert(glm::vec3(kAlbedo))).orthographic({0, 0, 0.5F}, {0, 0, 0}, 1e-3F);
    add(builder);
    return builder;
}

// Light of the sky comes by light sampling and by bounces. Within a black sphere there is none, unless the sphere's back faces are not
// there.
TEST(Sides, SkyShinesThroughBackFaces)
{
    for (const bool doubleSided : {false, true}) {
        const Scene scene = floorBelow([doubleSided](SceneBuilder& builder) {
                                builder.sphere({0, 0, 0}, 10.0F, builder.lambert(glm::vec3(0.0F), glm::vec3(0.0F), doubleSided))
                                    .environment(glm::vec3(1.0F));
                            }).scene();
        expectScreen(scene, doubleSided ? 0.0 : 0.5);
    }
}

// A point light above a black roof: I / h^2 arrives, and albedo / pi of it is seen.
TEST(Sides, ShadowRaysPassBackFaces)
{
    constexpr float kIntensity = 12.0F;
    for (const bool hides : {false, true}) {
        const Scene scene = floorBelow([hides](SceneBuilder& builder) {
                                builder.quad(screen(1.0F, !hides), builder.lambert(glm::vec3(0.0F)))
                                    .light({"", PunctualLight::Kind::Point, {0, 0, 2}, {0, 0, -1}, glm::vec3(kIntensity)});
                            }).scene();
        const double seen = static_cast<double>(kAlbedo) / std::numbers::pi * static_cast<double>(kIntensity) / 4.0;
        expectScreen(scene, hides ? 0.0 : seen);
    }
}

// A mirror shows a screen that stands behind the camera, or what is behind it.
TEST(Sides, BouncesPassBackFaces)
{
    for (const bool front : {false, true}) {
        SceneBuilder builder;
        builder.quad(screen(0.0F, true), builder.mirror(glm::vec3(0.8F)))
            .quad(screen(4.0F, !front), builder.lambert(glm::vec3(0.0F), glm::vec3(2.0F)))
            .environment(glm::vec3(1.0F))
            .perspective({0, 0, 3}, {0, 0, 0}, 0.2F);
        expectScreen(builder.scene(), front ? 1.6 : 0.8);
    }
}

// Screens at random between a lamp, a sky, a point light and a floor. Every other emits.
Scene manyScreens()
{
    SceneBuilder builder;
    Random random(8);
    builder.quad({glm::vec3(-3, -1, 3), {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}}, builder.lambert({0.7F, 0.6F, 0.5F}));
    const auto white = builder.lambert(glm::vec3(0.8F)), lamp = builder.lambert(glm::vec3(0.3F), glm::vec3(1.5F, 1.0F, 0.5F));
    for (int i = 0; i < 24; ++i) {
        const glm::vec3 center = 1.5F * glm::vec3(random.direction()), a(0.5 * random.direction()), b(0.5 * random.direction());
        builder.polygon({center - a, center + a, center + b}, i % 2 == 0 ? white : lamp);
    }
    builder.sphere({0, 0, 0}, 0.4F, lamp).sphere({0.2F, 0.2F, 0.2F}, 1.6F, white);
    builder.light({"", PunctualLight::Kind::Point, {0, 2, 0}, {0, 0, -1}, glm::vec3(4.0F)});
    builder.environment(glm::vec3(0.1F, 0.2F, 0.4F)).perspective({0, 0.5F, 1.5F}, {0, -0.2F, 0}, 1.2F);
    return builder.scene();
}

class SidesTest : public testing::TestWithParam<test::Named<DirectLight>> {};

// Light sampling and BSDF sampling see the same surfaces.
TEST_P(SidesTest, EstimatorsOfDirectLightAgree)
{
    RenderSettings settings = squareSettings(32, samplesFor(256));
    settings.bounces = 3;
    const Film production = renderScene(manyScreens(), settings);
    settings.seed = 1;
    settings.course.direct = GetParam().value;
    settings.course.lightSamples = 1;
    // Rays from within the large sphere pass it: a course's kernel, so that it is not the production's picture again.
    settings.course.intersector = Intersector::MollerTrumbore;
    expectSameMean(GetParam().name, renderScene(manyScreens(), settings), production);
}

INSTANTIATE_TEST_SUITE_P(Ways, SidesTest,
                         testing::Values(test::Named{"mis", DirectLight::Mis}, test::Named{"lights", DirectLight::Lights},
                                         test::Named{"hemisphere", DirectLight::Hemisphere}, test::Named{"bsdf", DirectLight::Bsdf}),
                         test::nameOfParameter);

}  // namespace
}  // namespace glim
