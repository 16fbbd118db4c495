#include "host/render/course_rounds.hpp"
#include "shaders/shared/course_types.h"

#include "host/error.hpp"
#include "shaders/shared/path_types.h"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <string>

namespace glim {
namespace {

constexpr DirectLight kModes[] = {DirectLight::Mis, DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf};

FlatScene sceneWith(const std::vector<uint>& kinds)
{
    FlatScene scene;
    for (const uint kind : kinds) {
        FlatLight light{};
        light.kind = kind;
        scene.lights.push_back(light);
        scene.features |= kind == kTriangleLight      ? kFeatureTriangleLights
                          : kind == kSphereLight      ? kFeatureSphereLights
                          : kind == kEnvironmentLight ? kFeatureEnvironment
                                                      : kFeaturePunctualLights;
    }
    return scene;
}

// "1:0/4" is sample 0 of 4 of light 1; "any" and "none" in the place of the light, "hemisphere" for a direction of it.
std::string roundsOf(const std::vector<uint>& kinds, DirectLight direct, std::uint32_t lightSamples)
{
    RenderSettings settings;
    settings.course.direct = direct;
    settings.course.lightSamples = lightSamples;
    std::string text;
    for (const LightRound& round : lightRounds(sceneWith(kinds), settings)) {
        EXPECT_TRUE(!round.hemisphere || round.light == kNoLightIndex);
        const std::string light = round.hemisphere               ? "hemisphere"
                                  : round.light == kAnyLight     ? "any"
                                  : round.light == kNoLightIndex ? "none"
                                                                 : std::to_string(round.light);
        text += (text.empty() ? "" : " ") + light + ":" + std::to_string(round.sample) + "/" + std::to_string(round.samples);
    }
    return text;
}

// The round without a light still adds the light that scattered rays find.
TEST(LightRoundsTest, NoLight)
{
    for (const DirectLight direct : kModes) {
        EXPECT_EQ(roundsOf({}, direct, 4), "none:0/1");
    }
}

TEST(LightRoundsTest, MisTakesOneLightOfAll)
{
    EXPECT_EQ(roundsOf({kTriangleLight}, DirectLight::Mis, 1), "any:0/1");
    EXPECT_EQ(roundsOf({kPointLight, kTriangleLight, kEnvironmentLight}, DirectLight::Mis, 8), "any:0/1");
}

TEST(LightRoundsTest, LightsTakesEachOfThem)
{
    EXPECT_EQ(roundsOf({kSphereLight}, DirectLight::Lights, 1), "0:0/1");
    EXPECT_EQ(roundsOf({kEnvironmentLight}, DirectLight::Lights, 3), "0:0/3 0:1/3 0:2/3");
    EXPECT_EQ(roundsOf({kTriangleLight, kSphereLight, kEnvironmentLight}, DirectLight::Lights, 2), "0:0/2 0:1/2 1:0/2 1:1/2 2:0/2 2:1/2");
}

// More samples of a delta light would all be the same.
TEST(LightRoundsTest, DeltaLightsAreSampledOnceInEachMode)
{
    const std::vector<uint> deltas = {kPointLight, kSpotLight, kDirectionalLight};
    for (const DirectLight direct : {DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        EXPECT_EQ(roundsOf(deltas, direct, 4), "0:0/1 1:0/1 2:0/1");
    }
    EXPECT_EQ(roundsOf({kTriangleLight, kSpotLight}, DirectLight::Lights, 2), "0:0/2 0:1/2 1:0/1");
    EXPECT_EQ(roundsOf({kTriangleLight, kSpotLight}, DirectLight::Bsdf, 2), "1:0/1");
}

TEST(LightRoundsTest, HemisphereComesAfterARoundThatAddsWhatWasFound)
{
    for (const uint kind : {kTriangleLight, kSphereLight, kEnvironmentLight}) {
        EXPECT_EQ(roundsOf({kind}, DirectLight::Hemisphere, 1), "none:0/1 hemisphere:0/1");
    }
    EXPECT_EQ(roundsOf({kEnvironmentLight, kTriangleLight, kPointLight}, DirectLight::Hemisphere, 3),
              "2:0/1 hemisphere:0/3 hemisphere:1/3 hemisphere:2/3");
}

TEST(LightRoundsTest, BsdfLeavesSurfacesAndSkyToTheRay)
{
    EXPECT_EQ(roundsOf({kTriangleLight, kSphereLight, kEnvironmentLight}, DirectLight::Bsdf, 4), "none:0/1");
}

TEST(LightRounds, MoreThanAMillionAreRefused)
{
    RenderSettings settings;
    settings.course.direct = DirectLight::Lights;
    settings.course.lightSamples = 65536;
    const std::vector<uint> kinds(16, kSphereLight);
    EXPECT_EQ(lightRounds(sceneWith(kinds), settings).size(), 1U << 20);
    test::expectRefusal<InputError>([&] { lightRounds(sceneWith(std::vector<uint>(17, kSphereLight)), settings); }, MessageId::TooLarge,
                                    {.place = "--direct", .value = "1114112", .expected = "at most 1048576"});
}

}  // namespace
}  // namespace glim
