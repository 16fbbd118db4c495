// --direct: four ways to estimate direct light, which have the same mean.
#include "host/error.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

// A closed room with a lamp under the ceiling and two spheres.
Scene room()
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F, 0.6F, 0.5F));
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(5.0F));
    builder.cube(1.0F, white, true)
        .quad({glm::vec3(-0.4F, 0.9F, -0.4F), {0.4F, 0.9F, -0.4F}, {0.4F, 0.9F, 0.4F}, {-0.4F, 0.9F, 0.4F}}, lamp)
        .sphere({-0.4F, -0.6F, -0.3F}, 0.4F, builder.lambert(glm::vec3(0.2F, 0.5F, 0.8F)))
        .sphere({0.5F, -0.7F, 0.2F}, 0.3F, builder.mirror(glm::vec3(0.9F)))
        .perspective({0.0F, 0.0F, 0.95F}, {0, -0.2F, 0}, 1.2F);
    return builder.scene();
}

// A floor under a sky, with a sphere light and a light that shines to both sides.
Scene yard()
{
    SceneBuilder builder;
    const auto floor = builder.lambert(glm::vec3(0.6F));
    const auto ball = builder.lambert(glm::vec3(0.3F), glm::vec3(3.0F, 2.0F, 1.0F));
    const auto sheet = builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F, 2.0F, 3.0F), true);
    builder.quad({glm::vec3(-3, 0, 3), {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}}, floor)
        .quad({glm::vec3(0.5F, 0.2F, -1), {0.5F, 0.2F, 1}, {0.5F, 1.2F, 1}, {0.5F, 1.2F, -1}}, sheet)
        .sphere({-1.0F, 0.6F, 0.0F}, 0.5F, ball)
        .environment(glm::vec3(0.3F, 0.4F, 0.5F))
        .perspective({0, 2, 5}, {0, 0.3F, 0}, 0.7F);
    return builder.scene();
}

// Smooth triangles, whose normals lean away from their faces, between a lamp and a sky.
Scene smoothBall()
{
    SceneBuilder builder;
    builder.lambert(glm::vec3(0.7F, 0.6F, 0.5F));
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(4.0F));
    builder.sphere({1.5F, 1.5F, 1.0F}, 0.4F, lamp).environment(glm::vec3(0.2F, 0.3F, 0.4F)).perspective({0, 0.5F, 4}, {0, 0, 0}, 0.6F);
    Scene scene = builder.scene();
    addMesh(scene, icosphere(1), 0, listVertices(icosphere(1)));
    return scene;
}

// Scenes whose light comes from a lamp in a closed room, and from 1,280 triangles that are a cluster of lights.
Scene closedRoom() { return loadGltf(GLIM_SOURCE_DIR "/scenes/closed_room.gltf"); }
Scene shadedLamp() { return loadGltf(GLIM_SOURCE_DIR "/scenes/shaded_lamp.gltf"); }

struct Place {
    const char* name;
    Scene (*scene)();
    bool hasManyLights = false;  // too many to sample each at every hit, as the course does
};

struct Way {
    const char* name;
    DirectLight direct;
    std::uint32_t lightSamples, spp;
};

void PrintTo(const Place& place, std::ostream* out) { *out << place.name; }

class DirectLightTest : public testing::TestWithParam<Place> {};

RenderSettings independent(std::uint32_t side, std::uint32_t spp, std::uint32_t bounces)
{
    RenderSettings settings = squareSettings(side, spp);
    settings.sampler = Sampler::Independent;
    settings.bounces = bounces;
    return settings;
}

const Way kWays[] = {{"lights", DirectLight::Lights, 1, 256},
                     {"lights4", DirectLight::Lights, 4, 64},
                     {"hemisphere", DirectLight::Hemisphere, 1, 1024},
                     {"hemisphere8", DirectLight::Hemisphere, 8, 256},
                     {"bsdf", DirectLight::Bsdf, 1, 1024}};

TEST_P(DirectLightTest, HasTheMeanOfTheDefault)
{
    const Place place = GetParam();
    const FlatScene flat = flattened(place.scene());
    const Camera camera = place.scene().cameras.front();
    const Film expected = renderFlat(flat, camera, independent(32, samplesFor(512), 4));
    for (const Way& way : kWays) {
        if (place.hasManyLights && way.direct == DirectLight::Lights) {
            continue;
        }
        RenderSettings settings = independent(32, samplesFor(way.spp), 4);
        settings.seed = 1;
        settings.course.direct = way.direct;
        settings.course.lightSamples = way.lightSamples;
        expectSameMean(std::string(place.name) + ", " + way.name, renderFlat(flat, camera, settings), expected);
    }
}

// The mixed scene has a point light, which every way must sample: no direction meets it.
INSTANTIATE_TEST_SUITE_P(Places, DirectLightTest,
                         testing::Values(Place{"room", room}, Place{"yard", yard}, Place{"mixed", mixedScene}, Place{"smooth", smoothBall},
                                         Place{"closedRoom", closedRoom}, Place{"shadedLamp", shadedLamp, true}),
                         [](const auto& test) { return std::string(test.param.name); });

// T3 in a round room: a sphere that emits inwards sees all of itself.
TEST(DirectLightTest, T3ASphereFromWithin)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F, 2.0F, 0.5F), true))
        .perspective({0.3F, 0.2F, 0.5F}, {-1, -0.5F, -1}, 1.0F);
    for (const DirectLight direct : {DirectLight::Mis, DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        for (const std::uint32_t bounces : {1U, 5U}) {
            RenderSettings settings = independent(48, samplesFor(128), bounces);
            settings.course.direct = direct;
            const double truth = (1.0 - std::pow(0.5, bounces + 1.0)) / 0.5;
            expectMean("round room, way " + std::to_string(static_cast<int>(direct)) + ", bounces " + std::to_string(bounces),
                       renderScene(builder.scene(), settings), truth * glm::dvec3(1.0, 2.0, 0.5));
        }
    }
}

// The same wall shines outwards only: inside it is dark.
TEST(DirectLightTest, OneSidedSpheresAreDarkInside)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F)))
        .perspective({0.3F, 0.2F, 0.5F}, {-1, -0.5F, -1}, 1.0F);
    for (const DirectLight direct : {DirectLight::Mis, DirectLight::Lights, DirectLight::Hemisphere, DirectLight::Bsdf}) {
        RenderSettings settings = squareSettings(16, 32);
        settings.course.direct = direct;
        EXPECT_EQ(meanOf(renderScene(builder.scene(), settings)).mean, glm::dvec3(0.0)) << static_cast<int>(direct);
    }
}

// With many rounds a pass takes minutes. A render that is ended does not wait for such a pass, and keeps nothing of it. It
// finishes a short pass.
TEST(DirectLightTest, ALongPassMayEndBeforeItsLastRound)
{
    const Scene scene = room();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(4, 2);
    settings.course.direct = DirectLight::Lights;
    for (const std::uint32_t lightSamples : {1U, 65536U}) {
        settings.course.lightSamples = lightSamples;
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        const Film film = renderer.render([](const RenderProgress&) { return false; });
        EXPECT_EQ(renderer.statistics().samples, lightSamples == 1 ? 16U : 0U);
        EXPECT_EQ(film.complete, lightSamples == 1) << "one sample of each pixel";
        for (const PixelMoments& pixel : film.pixels) {
            EXPECT_EQ(pixel.count, lightSamples == 1 ? 1U : 0U);
        }
    }
}

double meanVariance(const FlatScene& flat, const Camera& camera, const RenderSettings& settings)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : renderFlat(flat, camera, settings).pixels) {
        sum += static_cast<double>(computeVarianceOfMean(pixel).g);
    }
    return sum;
}

// Directly lit pixels of a floor that see neither light nor edge: all noise is of the light's samples. With Sobol' points N of
// them do better than N independent ones, whose variance is 1/N. 32 x 32 pixels of 8 blocks: 2.4 % standard error.
TEST(LightSamplesTest, DivideTheVariance)
{
    SceneBuilder builder;
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(5.0F));
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F)))
        .quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, lamp)
        .orthographic({0.0F, 0.5F, 0.0F}, {0, 0, 0}, 0.3F);
    const FlatScene flat = flattened(builder.scene());
    const Camera camera = builder.scene().cameras.front();
    for (const DirectLight direct : {DirectLight::Lights, DirectLight::Hemisphere}) {
        RenderSettings settings = independent(32, 256, 1);
        settings.course.direct = direct;
        const double one = meanVariance(flat, camera, settings);
        settings.course.lightSamples = 8;
        EXPECT_NEAR(one / meanVariance(flat, camera, settings), 8.0, 8.0 * 4.0 * 0.034);
        settings.sampler = Sampler::Sobol;
        EXPECT_GT(one / meanVariance(flat, camera, settings), 8.0 * (1.0 + 5.0 * 0.034));
    }
}

std::uint64_t shadowRays(const FlatScene& flat, const Camera& camera, DirectLight direct, std::uint32_t lightSamples)
{
    RenderSettings settings = squareSettings(8, 4);
    settings.bounces = 1;
    settings.course.direct = direct;
    settings.course.lightSamples = lightSamples;
    Renderer renderer(testDevice(), flat, flattenCamera(camera, 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    return renderer.statistics().shadowRays;
}

// Everything sees both lights: of an area light N samples, of a point light one.
TEST(LightSamplesTest, CountPerLightAndHit)
{
    SceneBuilder builder;
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(5.0F));
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F)))
        .quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, lamp)
        .light({"", PunctualLight::Kind::Point, {0, 0.8F, 0}, {0, 0, -1}, glm::vec3(1.0F)})
        .orthographic({0.0F, 0.5F, 0.0F}, {0, 0, 0}, 0.3F);
    const FlatScene flat = flattened(builder.scene());
    const Camera camera = builder.scene().cameras.front();
    const std::uint64_t hits = 8 * 8 * 4;
    EXPECT_EQ(shadowRays(flat, camera, DirectLight::Mis, 1), hits);
    EXPECT_EQ(shadowRays(flat, camera, DirectLight::Lights, 1), 2 * hits);
    EXPECT_EQ(shadowRays(flat, camera, DirectLight::Lights, 5), 6 * hits);
    EXPECT_EQ(shadowRays(flat, camera, DirectLight::Hemisphere, 5), 6 * hits);
    EXPECT_EQ(shadowRays(flat, camera, DirectLight::Bsdf, 1), hits);
}

// A picture without them would be wrong.
TEST(DirectLightRefusalTest, OfFeaturesThatTheCourseLacks)
{
    RenderSettings settings = squareSettings(8, 1);
    settings.course.direct = DirectLight::Bsdf;
    const auto render = [&](const char* file) {
        return [&, file] { renderScene(loadGltf(std::string(GLIM_SOURCE_DIR "/scenes/") + file), settings); };
    };
    test::expectRefusal<InputError>(render("liquid.gltf"), MessageId::Unsupported,
                                    {.value = "solids that absorb light or lie within each other"});
    test::expectRefusal<InputError>(render("textures.gltf"), MessageId::Unsupported, {.value = "surfaces that are transparent in places"});
}

}  // namespace
}  // namespace glim
