// Caustics by light paths: against answers known on paper, against path tracing, and the same bits however the work is cut.
#include "host/flatten/flatten_scene.hpp"
#include "host/measure/confidence.hpp"
#include "host/measure/z_test.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/parameters.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/test_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;
// Of each z-test: some 20 pictures, two tests each.
constexpr double kLevel = 1e-3 / 40;

Film renderWith(const FlatScene& flat, const FlatCamera& camera, RenderSettings settings, bool caustics)
{
    settings.caustics = caustics;
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, camera, settings);
    Film film = renderer.render([](const RenderProgress&) { return true; });
    EXPECT_EQ(renderer.statistics().nonFinite, 0U);
    return film;
}

void expectAgreement(const std::string& name, const Picture& picture, const Picture& reference)
{
    const ZTest test = zTest(picture, reference, kLevel);
    std::printf("%s: z of means %.2f %.2f %.2f, of blocks at most %.2f; sees a bias of %.2g\n", name.c_str(), test.meanZ[0], test.meanZ[1],
                test.meanZ[2], test.worstZ, test.detectableBias);
    EXPECT_TRUE(test.meansAgree()) << name << ": " << test.meanZ[0] << ' ' << test.meanZ[1] << ' ' << test.meanZ[2];
    EXPECT_TRUE(test.blocksAgree()) << name << ": " << test.worstZ << " at " << test.worstX << ", " << test.worstY;
}

double meanOfSplats(const Film& film)
{
    double sum = 0.0;
    for (const SplatMoments& splat : film.splats) {
        sum += static_cast<double>(splat.mean.r + splat.mean.g + splat.mean.b);
    }
    return sum / (3.0 * static_cast<double>(film.splats.size()));
}

// A floor y = 0 beside a mirror x = -1 that reflects everything, seen from above by parallel rays.
constexpr float kHalf = 0.4F;
const glm::vec3 kRho(0.8F, 0.5F, 0.2F);

SceneBuilder floorAndMirror(const PunctualLight& light)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(kRho))
        .quad({glm::vec3(-1, 0, 1), {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}}, builder.mirror(glm::vec3(1.0F)))
        .light(light)
        .orthographic({0.2F, 2.5F, 0.0F}, {0.2F, 0.0F, 0.0F}, kHalf);
    return builder;
}

// Irradiance that the light gives the floor at p, without occlusion. Its range counts to the first surface, which is the mirror after
// `part` of the way.
double irradianceAt(const PunctualLight& light, const glm::dvec3& p, double part = 1.0)
{
    if (light.kind == PunctualLight::Kind::Directional) {
        return static_cast<double>(light.intensity.r) * std::max(0.0, -static_cast<double>(light.direction.y));
    }
    const glm::dvec3 towards = glm::dvec3(light.position) - p;
    const double distance2 = glm::dot(towards, towards), distance = std::sqrt(distance2);
    double intensity = static_cast<double>(light.intensity.r);
    if (light.kind == PunctualLight::Kind::Spot) {
        const double versine = 1.0 + glm::dot(towards, glm::dvec3(light.direction)) / distance;
        const double ramp =
            (static_cast<double>(light.versineOuter) - versine) / static_cast<double>(light.versineOuter - light.versineInner);
        intensity *= std::pow(std::clamp(ramp, 0.0, 1.0), 2.0);
    }
    if (light.range > 0.0F) {
        const double share = part * part * distance2 / std::pow(static_cast<double>(light.range), 2.0);
        intensity *= std::clamp(1.0 - share * share, 0.0, 1.0);
    }
    return intensity * towards.y / distance / distance2;
}

PunctualLight mirrored(PunctualLight light)
{
    light.position.x = -2.0F - light.position.x;
    light.direction.x = -light.direction.x;
    return light;
}

// The mean of rho / pi times the irradiance of the light and of its image over each pixel, by 4 x 4 points.
Picture floorPicture(const PunctualLight& light, const Camera& camera, std::uint32_t side)
{
    Picture picture{side, side, {}, std::vector<glm::vec3>(std::size_t{side} * side, glm::vec3(0.0F))};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        double sum = 0.0;
        for (int sub = 0; sub < 16; ++sub) {
            const double x = (i % side + (sub % 4 + 0.5) / 4.0) / side, y = (i / side + (sub / 4 + 0.5) / 4.0) / side;
            glm::dvec3 p = glm::dvec3(camera.position) + static_cast<double>(kHalf) * ((2.0 * x - 1.0) * glm::dvec3(camera.right) +
                                                                                       (1.0 - 2.0 * y) * glm::dvec3(camera.up));
            p.y = 0.0;
            const PunctualLight image = mirrored(light);
            const double behind = -1.0 - static_cast<double>(image.position.x);
            sum += irradianceAt(light, p) + irradianceAt(image, p, behind / (behind + 1.0 + p.x));
        }
        picture.radiance.push_back(kRho * static_cast<float>(sum / (16.0 * kPi)));
    }
    return picture;
}

class MirroredLightTest : public testing::TestWithParam<test::Named<PunctualLight>> {};

// A plane mirror makes a second light. With two surfaces at most there is nothing else.
TEST_P(MirroredLightTest, IsAnImageOfIt)
{
    const PunctualLight light = GetParam().value;
    const Scene scene = floorAndMirror(light).scene();
    RenderSettings settings = squareSettings(32, samplesFor(8192));
    settings.bounces = 2;
    const Film film = renderScene(scene, settings);
    ASSERT_FALSE(film.splats.empty());
    expectAgreement(GetParam().name, pictureOf(film), floorPicture(light, scene.cameras.front(), 32));
}

INSTANTIATE_TEST_SUITE_P(
    Lights, MirroredLightTest,
    testing::Values(
        test::Named{"point", PunctualLight{"", PunctualLight::Kind::Point, {0.5F, 1.2F, 0.3F}, {0, 0, -1}, glm::vec3(3.0F)}},
        test::Named{"range",
                    PunctualLight{"", PunctualLight::Kind::Point, {0.1F, 0.6F, 0.1F}, {0, 0, -1}, glm::vec3(3.0F), 0.0F, 1.0F, 1.6F}},
        test::Named{"spot", PunctualLight{"",
                                          PunctualLight::Kind::Spot,
                                          {0.5F, 1.2F, 0.3F},
                                          glm::normalize(glm::vec3(-1.5F, -0.6F, -0.3F)),
                                          glm::vec3(3.0F),
                                          0.1F,
                                          0.4F}},
        test::Named{"narrowSpot", PunctualLight{"",
                                                PunctualLight::Kind::Spot,
                                                {0.5F, 1.2F, 0.3F},
                                                glm::normalize(glm::vec3(-1.5F, -0.6F, -0.3F)),
                                                glm::vec3(3.0F),
                                                1e-4F,
                                                3e-4F}},
        test::Named{"directional",
                    PunctualLight{
                        "", PunctualLight::Kind::Directional, {0, 0, 0}, glm::normalize(glm::vec3(-0.7F, -0.6F, 0.1F)), glm::vec3(3.0F)}}),
    test::nameOfParameter);

// A white floor and back wall, a lamp above, and what the variants add.
struct Variant {
    SceneBuilder builder;
    Lens lens;
    std::function<void(Scene&)> change = [](Scene&) {};
    RenderSettings settings = squareSettings(32, samplesFor(2048));
};

enum class Lamp { Rectangle, TwoSidedTriangle, Sphere, TwoSidedSphere };

Variant room(Lamp lamp = Lamp::Rectangle)
{
    Variant variant;
    SceneBuilder& b = variant.builder;
    const auto white = b.lambert(glm::vec3(0.7F, 0.6F, 0.5F));
    const bool both = lamp == Lamp::TwoSidedTriangle || lamp == Lamp::TwoSidedSphere;
    const auto light = b.lambert(glm::vec3(0.3F), glm::vec3(8.0F, 7.0F, 5.0F), both);
    b.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, white)
        .quad({glm::vec3(-2, -1, -2), {2, -1, -2}, {2, 2, -2}, {-2, 2, -2}}, white)
        .perspective({0.0F, 0.4F, 4.0F}, {0, 0, 0}, 0.8F);
    if (lamp == Lamp::Rectangle) {
        b.quad({glm::vec3(-0.5F, 1.5F, -0.5F), {0.5F, 1.5F, -0.5F}, {0.5F, 1.5F, 0.5F}, {-0.5F, 1.5F, 0.5F}}, light);
    } else if (lamp == Lamp::TwoSidedTriangle) {
        b.polygon({glm::vec3(-0.4F, 0.9F, 0.5F), {0.5F, 0.7F, 0.2F}, {0.1F, 1.2F, -0.4F}}, light);
    } else {
        b.sphere({-0.2F, 1.1F, 0.3F}, 0.3F, light);
    }
    return variant;
}

void addGlass(SceneBuilder& b) { b.sphere({0.6F, -0.4F, 0.3F}, 0.6F, b.glass(1.5F)); }
void addMirror(SceneBuilder& b) { b.sphere({-0.8F, -0.5F, 0.2F}, 0.5F, b.mirror({0.9F, 0.8F, 0.7F})); }

// A sphere of triangles with smooth normals.
void addSmooth(Scene& scene, const Material& material, const glm::vec3& center, float radius)
{
    scene.materials.push_back(material);
    const Triangles sphere = icosphere(2);
    Triangles placed = sphere;
    for (Triangle& triangle : placed) {
        for (glm::vec3& v : triangle.vertices) {
            v = center + radius * v;
        }
    }
    addMesh(scene, placed, static_cast<std::uint32_t>(scene.materials.size() - 1), verticesOf(sphere));
}

// A pane before the camera's right half and between lamp and balls.
void addPane(Scene& scene, const Material& material)
{
    scene.materials.push_back(material);
    const glm::vec3 a(0, -1, 1.2F), b(2, -1, 1.2F), c(2, 1, 1.2F), d(0, 1, 1.2F);
    addMesh(scene, {{{a, b, c}}, {{a, c, d}}}, static_cast<std::uint32_t>(scene.materials.size() - 1));
    const glm::vec3 e(0.2F, 0.6F, 1), f(2, 0.6F, 1), g(2, 0.6F, -1), h(0.2F, 0.6F, -1);
    addMesh(scene, {{{e, f, g}}, {{e, g, h}}}, static_cast<std::uint32_t>(scene.materials.size() - 1));
}

Material solid()
{
    Material m;
    m.transmission = 1.0F;
    m.solid = true;
    m.metallic = m.roughness = 0.0F;
    return m;
}

Material plastic(float roughness)
{
    Material m;
    m.baseColor = {0.2F, 0.5F, 0.7F};
    m.metallic = 0.0F;
    m.roughness = roughness;
    return m;
}

struct NamedVariant {
    const char* name;
    std::function<Variant()> make;
};

Variant balls(Lamp lamp = Lamp::Rectangle)
{
    Variant v = room(lamp);
    addGlass(v.builder);
    addMirror(v.builder);
    return v;
}

Variant changed(Variant v, std::function<void(Scene&)> change)
{
    v.change = std::move(change);
    return v;
}

const NamedVariant kVariants[] = {
    {"balls", [] { return balls(); }},
    {"mirrorQuad",
     [] {
         Variant v = room();
         v.builder.quad({glm::vec3(-1, -1, 1), {-1.3F, -1, -1}, {-1.3F, 1, -1}, {-1, 1, 1}}, v.builder.mirror(glm::vec3(0.9F)));
         return v;
     }},
    {"twoSidedTriangle", [] { return balls(Lamp::TwoSidedTriangle); }},
    {"sphereLamp", [] { return balls(Lamp::Sphere); }},
    {"twoSidedSphere", [] { return balls(Lamp::TwoSidedSphere); }},
    {"orthographic",
     [] {
         Variant v = balls();
         v.change = [](Scene& scene) {
             scene.cameras.front().kind = Camera::Kind::Orthographic;
             scene.cameras.front().halfWidth = scene.cameras.front().halfHeight = 1.4F;
         };
         return v;
     }},
    {"lens",
     [] {
         Variant v = balls();
         v.lens = {0.2F, 3.0F};
         return v;
     }},
    {"orthographicLens",
     [] {
         Variant v = balls();
         v.lens = {0.2F, 3.0F};
         v.change = [](Scene& scene) {
             scene.cameras.front().kind = Camera::Kind::Orthographic;
             scene.cameras.front().halfWidth = scene.cameras.front().halfHeight = 1.4F;
         };
         return v;
     }},
    {"smoothGlass", [] { return changed(room(), [](Scene& scene) {
                             addSmooth(scene, solid(), {0.3F, -0.3F, 0.3F}, 0.6F);
                         }); }},
    {"smoothMirror",
     [] {
         return changed(room(), [](Scene& scene) {
             Material metal;
             metal.roughness = 0.0F;
             addSmooth(scene, metal, {0.3F, -0.3F, 0.3F}, 0.6F);
         });
     }},
    {"smoothReceiver", [] { return changed(balls(), [](Scene& scene) {
                                addSmooth(scene, plastic(0.6F), {0.0F, -0.7F, 1.0F}, 0.3F);
                            }); }},
    {"coat",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.5F);
             m.clearcoat = 1.0F;
             addSmooth(scene, m, {0.0F, -0.6F, 1.0F}, 0.4F);
         });
     }},
    {"polished", [] { return changed(balls(), [](Scene& scene) {
                          addSmooth(scene, plastic(0.0F), {0.0F, -0.6F, 1.0F}, 0.4F);
                      }); }},
    {"absorption",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = solid();
             m.absorption = {0.2F, 1.0F, 3.0F};
             addSmooth(scene, m, {0.0F, -0.6F, 1.0F}, 0.4F);
         });
     }},
    {"dispersion",
     [] {
         return changed(room(), [](Scene& scene) {
             Material m = solid();
             m.dispersion = 3.0F;
             addSmooth(scene, m, {0.3F, -0.3F, 0.3F}, 0.6F);
         });
     }},
    {"roughGlass",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = solid();
             m.roughness = 0.5F;
             addSmooth(scene, m, {0.0F, -0.6F, 1.0F}, 0.4F);
         });
     }},
    {"leaf",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.7F);
             m.diffuseTransmission = 0.6F;
             addSmooth(scene, m, {0.0F, -0.6F, 1.0F}, 0.4F);
         });
     }},
    {"alpha",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.7F);
             m.alphaMode = AlphaMode::Blend;
             m.alpha = 0.4F;
             addPane(scene, m);
         });
     }},
    {"thinWall",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.0F);
             m.transmission = 0.9F;
             addPane(scene, m);
         });
     }},
    {"unlit",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.0F);
             m.unlit = true;
             addPane(scene, m);
         });
     }},
    {"threeBounces",
     [] {
         Variant v = balls();
         v.settings.bounces = 3;
         return v;
     }},
    {"indirect",
     [] {
         Variant v = balls();
         v.settings.paths = PathParts::Indirect;
         return v;
     }},
};

class CausticsTest : public testing::TestWithParam<NamedVariant> {};

// With and without light paths: the same light.
TEST_P(CausticsTest, AgreeWithPathTracing)
{
    const Variant variant = GetParam().make();
    Scene scene = variant.builder.scene();
    variant.change(scene);
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F, variant.lens);
    const Film light = renderWith(flat, camera, variant.settings, true);
    RenderSettings others = variant.settings;
    others.seed = 1;
    const Film path = renderWith(flat, camera, others, false);
    ASSERT_FALSE(light.splats.empty());
    EXPECT_TRUE(path.splats.empty());
    EXPECT_GT(meanOfSplats(light), 0.0);
    expectAgreement(GetParam().name, pictureOf(light), pictureOf(path));
}

INSTANTIATE_TEST_SUITE_P(Scenes, CausticsTest, testing::ValuesIn(kVariants),
                         [](const auto& variant) { return std::string(variant.param.name); });

// Directional light is that of a point light far away.
TEST(CausticsOfLightsTest, DirectionalLightIsAPointFarAway)
{
    constexpr float kDistance = 1000.0F;
    const glm::vec3 direction = glm::normalize(glm::vec3(-0.3F, -1.0F, -0.2F));
    const auto render = [&](const PunctualLight& light) {
        SceneBuilder b;
        b.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, b.lambert(glm::vec3(0.7F)));
        addGlass(b);
        addMirror(b);
        b.light(light).perspective({0.0F, 2.0F, 4.0F}, {0, -1, 0}, 0.8F);
        return renderScene(b.scene(), squareSettings(32, samplesFor(512)));
    };
    const Film sun = render({"", PunctualLight::Kind::Directional, {0, 0, 0}, direction, glm::vec3(3.0F)});
    const Film lamp = render({"", PunctualLight::Kind::Point, -kDistance * direction, direction, glm::vec3(3.0F * kDistance * kDistance)});
    const double a = meanOfSplats(sun), b = meanOfSplats(lamp);
    const auto errorOf = [](const Film& film) {
        double sum = 0.0;
        for (const SplatMoments& splat : film.splats) {
            sum += static_cast<double>(splat.squares.g) / ((splat.blocks - 1.0) * splat.count);
        }
        return std::sqrt(sum) / static_cast<double>(film.splats.size());
    };
    std::printf("caustics of the sun %.6f, of a far lamp %.6f, +- %.1e\n", a, b, std::hypot(errorOf(sun), errorOf(lamp)));
    EXPECT_GT(a, 0.0);
    // Ten times 1 / distance, by which directions differ over the balls.
    EXPECT_LE(std::abs(a - b), twoSidedLimit(kLevel) * std::hypot(errorOf(sun), errorOf(lamp)) + 0.01 * b);
}

RenderSettings small(std::uint32_t spp) { return squareSettings(40, spp); }

class CausticsFilmTest : public testing::Test {
protected:
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);

    Film render(const RenderSettings& settings) const { return renderWith(flat, camera, settings, true); }
};

TEST_F(CausticsFilmTest, HasTheSameBitsInBands)
{
    const Film whole = render(small(80));
    for (const std::uint32_t pixels : {100U, 173U}) {
        RenderSettings settings = small(80);
        settings.tilePixels = pixels;
        EXPECT_TRUE(sameBits(whole, render(settings))) << pixels;
    }
}

TEST_F(CausticsFilmTest, HasTheSameBitsOfPartsThatAreMerged)
{
    const test::ScratchFolder folder;
    RenderSettings first = small(256), second = small(400);
    second.sampleBegin = 256;
    writeFilm(folder / "a.exr", render(first));
    writeFilm(folder / "b.exr", render(second));
    const MergedFilm merged = mergeFilms({folder / "b.exr", folder / "a.exr"});
    EXPECT_TRUE(merged.exact);
    EXPECT_TRUE(sameBits(merged.film, render(small(400))));
}

TEST_F(CausticsFilmTest, CountsTheSamplesThatEachPixelHas)
{
    for (const std::uint32_t spp : {1U, 40U, 80U}) {
        const Film film = render(small(spp));
        EXPECT_EQ(film.splats.front().count, spp);
        EXPECT_EQ(film.splats.front().blocks, film.pixels.front().blocks) << spp;
    }
}

TEST_F(CausticsFilmTest, AdaptiveRendersHaveTheSameLight)
{
    RenderSettings settings = small(samplesFor(512));
    const Film plain = render(settings);
    settings.adaptive = Adaptive::Neighbours;
    settings.seed = 1;
    const Film adaptive = render(settings);
    expectAgreement("adaptive", pictureOf(adaptive), pictureOf(plain));
    EXPECT_EQ(adaptive.splats.front().count, settings.sampleEnd);
    settings.pathCapacity = 3000;
    EXPECT_TRUE(sameBits(adaptive, render(settings)));
}

TEST_F(CausticsFilmTest, ClampingSaysWhatItTakes)
{
    RenderSettings settings = small(64);
    const double whole = meanOfSplats(render(settings));
    settings.clampIndirect = 0.01F;
    const Film clamped = render(settings);
    double removed = 0.0;
    for (const SplatMoments& splat : clamped.splats) {
        removed += static_cast<double>(splat.clamped) / static_cast<double>(clamped.splats.size());
    }
    EXPECT_GT(removed, 0.01 * whole);
    EXPECT_NEAR(meanOfSplats(clamped) + removed, whole, 1e-5 * whole);
}

TEST_F(CausticsFilmTest, AnotherScaleOfLightScalesThePicture)
{
    const Film plain = render(small(64));
    for (const float scale : {0x1p-60F, 0x1p40F}) {
        Scene bright = scene;
        for (Material& material : bright.materials) {
            material.emission *= scale;
        }
        for (PunctualLight& light : bright.lights) {
            light.intensity *= scale;
        }
        bright.environment->radiance *= scale;
        const Film film = renderWith(flattened(bright), camera, small(64), true);
        for (std::size_t i = 0; i < film.splats.size(); ++i) {
            ASSERT_EQ(film.splats[i].mean, plain.splats[i].mean * scale) << i;
        }
    }
}

TEST_F(CausticsFilmTest, IsOffWhereTheCourseEstimates)
{
    EXPECT_TRUE(tracesLight(flat, small(64)));
    RenderSettings settings = small(64);
    settings.course.direct = DirectLight::Lights;
    EXPECT_FALSE(tracesLight(flat, settings));
    settings = small(64);
    settings.bounces = 1;
    EXPECT_FALSE(tracesLight(flat, settings));
    settings = small(64);
    settings.adaptive = Adaptive::Course;
    EXPECT_FALSE(tracesLight(flat, settings));
}

TEST(CausticsSceneTest, NeedsLampsAndSpecularSurfaces)
{
    const auto needs = [](const Scene& scene) { return (flattened(scene).features & kFeatureCaustics) != 0; };
    EXPECT_TRUE(needs(balls().builder.scene()));
    EXPECT_FALSE(needs(room().builder.scene()));
    SceneBuilder sky;
    addGlass(sky);
    sky.environment(glm::vec3(1.0F));
    EXPECT_FALSE(needs(sky.scene()));
    // A mirror for a wall and a lamp for a ceiling: camera paths meet it more often.
    SceneBuilder bright;
    bright.quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, bright.lambert(glm::vec3(0.0F), glm::vec3(1.0F)))
        .quad({glm::vec3(-1, -1, -1), {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}, bright.mirror(glm::vec3(0.9F)))
        .quad({glm::vec3(-1, -1, 1), {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}, bright.lambert(glm::vec3(0.7F)));
    EXPECT_FALSE(needs(bright.scene()));
    bright.light({"", PunctualLight::Kind::Point, {0, 0, 0}, {0, 0, -1}, glm::vec3(1.0F)});
    EXPECT_TRUE(needs(bright.scene()));
    Scene rough = room().builder.scene();
    addSmooth(rough, plastic(0.1F), {0, 0, 0}, 0.5F);
    EXPECT_FALSE(needs(rough));
}

}  // namespace
}  // namespace glim
