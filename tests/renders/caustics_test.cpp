// Caustics by light paths, against path tracing.
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/start_media.hpp"
#include "host/measure/confidence.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/caustic_films.hpp"
#include "tests/support/named.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>

namespace glim {
namespace {

using std::numbers::pi;

// A white floor and back wall, a lamp above, and what the variants add.
struct Variant {
    SceneBuilder builder;
    Lens lens;
    std::function<void(Scene&)> change = [](Scene&) {};
    RenderSettings settings = squareSettings(32, samplesFor(1024));
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
    addMesh(scene, placed, static_cast<std::uint32_t>(scene.materials.size() - 1), listVertices(sphere));
}

// A pane before the camera's right half and between lamp and balls: their fronts face camera and lamp, or if turned their backs.
void addPane(Scene& scene, const Material& material, bool turned = false)
{
    scene.materials.push_back(material);
    const glm::vec3 a(0, -1, 1.2F), b(2, -1, 1.2F), c(2, 1, 1.2F), d(0, 1, 1.2F);
    const auto quad = [turned](const glm::vec3& p, const glm::vec3& q, const glm::vec3& r, const glm::vec3& s) {
        return turned ? Triangles{{{r, q, p}}, {{s, r, p}}} : Triangles{{{p, q, r}}, {{p, r, s}}};
    };
    addMesh(scene, quad(a, b, c, d), static_cast<std::uint32_t>(scene.materials.size() - 1));
    const glm::vec3 e(0.2F, 0.6F, 1), f(2, 0.6F, 1), g(2, 0.6F, -1), h(0.2F, 0.6F, -1);
    addMesh(scene, quad(e, f, g, h), static_cast<std::uint32_t>(scene.materials.size() - 1));
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

using NamedVariant = test::Named<std::function<Variant()>>;

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

// A sky of a map with a sun that fills a texel, some 11 degrees wide.
void addSunnySky(Scene& scene)
{
    const auto map = std::make_shared<RadianceMap>(RadianceMap{32, 16, std::vector<glm::vec3>(32 * 16, glm::vec3(0.2F, 0.3F, 0.5F)), 0});
    map->texels[4 * 32 + 11] = glm::vec3(70.0F, 60.0F, 50.0F);
    scene.environment = Environment{glm::vec3(0.8F, 0.9F, 1.0F), map, 1.2F, true, "test"};
}

// Balls on a floor, under the sky alone.
Variant outdoors()
{
    Variant v;
    v.builder.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, v.builder.lambert(glm::vec3(0.7F, 0.6F, 0.5F)))
        .perspective({0.0F, 2.0F, 4.0F}, {0, -1, 0}, 0.8F);
    addGlass(v.builder);
    addMirror(v.builder);
    v.change = addSunnySky;
    return v;
}

// Amid the balls.
Variant projected(const Projection& projection)
{
    return changed(balls(), [projection](Scene& scene) {
        scene.cameras.front().position = {0.0F, 0.2F, 1.8F};
        scene.cameras.front().projection = projection;
    });
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
    {"underWater",  // with the camera and the lamp
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = solid();
             m.ior = 1.3F;
             m.absorption = {0.05F, 0.1F, 0.2F};
             addSmooth(scene, m, glm::vec3(0.0F), 9.0F);
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
    // Single-sided surfaces: light comes to the fronts of panes, where it scatters and passes, or ends at their backs.
    {"fronts", [] { return changed(balls(), [](Scene& scene) { addPane(scene, plastic(0.7F)); }); }},
    {"backs", [] { return changed(balls(), [](Scene& scene) { addPane(scene, plastic(0.7F), true); }); }},
    {"mirrorFronts",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material metal;
             metal.roughness = 0.0F;
             addPane(scene, metal);
         });
     }},
    {"alphaBacks",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material m = plastic(0.7F);
             m.alphaMode = AlphaMode::Blend;
             m.alpha = 0.4F;
             addPane(scene, m, true);
         });
     }},
    {"thinWallAndFronts",
     [] {
         return changed(balls(), [](Scene& scene) {
             Material thin = plastic(0.0F), half = plastic(0.7F);
             thin.transmission = 0.9F;
             half.alphaMode = AlphaMode::Blend;
             half.alpha = 0.4F;
             addPane(scene, thin);
             addPane(scene, half);
             for (glm::dvec3& p : scene.meshes.change().back().positions) {
                 p.y += 0.2;
             }
         });
     }},
    // Balls and camera are within a sphere, the lamp is not.
    {"withinASphere",
     [] {
         Variant v = balls();
         v.builder.sphere({0.1F, -0.6F, 0.3F}, 1.6F, v.builder.add(plastic(0.7F)));
         v.change = [](Scene& scene) { scene.cameras.front().position = {0.1F, -0.1F, 1.5F}; };
         return v;
     }},
    // Cameras whose projection is not linear.
    {"barrel",
     [] {
         return projected({Projection::Model::RadialTangential, std::nullopt, {0.2, -0.1}, {-0.2, 0.05, 0.01, -0.02}});
     }},
    {"fisheye",
     [] {
         const Intrinsics wide{{9.0, 10.0}, {14.0, 17.0}, {32.0, 32.0}};
         return projected({Projection::Model::Fisheye, wide, {}, {0.05, -0.02}});
     }},
    {"equirectangular",
     [] {
         return projected({Projection::Model::Equirectangular, std::nullopt, {}, {}});
     }},
    {"cropped",
     [] {
         return projected({Projection::Model::RadialTangential, std::nullopt, {}, {-0.1}, Crop{{9, 12}, {32, 32}, {64, 48}}});
     }},
    // Light paths carry the bright part of the sky, and camera paths the rest.
    {"sun", [] { return outdoors(); }},
    {"sunAndLamp", [] { return changed(balls(), addSunnySky); }},
    {"sunOnWater",  // from below
     [] {
         return changed(outdoors(), [](Scene& scene) {
             Material m = solid();
             m.ior = 1.3F;
             m.absorption = {0.05F, 0.1F, 0.2F};
             addSmooth(scene, m, glm::vec3(0.0F), 6.0F);
             addSunnySky(scene);
         });
     }},
    {"severalSuns",
     [] {
         return changed(outdoors(), [](Scene& scene) {
             addSunnySky(scene);
             auto map = std::make_shared<RadianceMap>(*scene.environment->map);
             map->texels[3 * 32 + 20] = map->texels[3 * 32 + 21] = map->texels[5 * 32 + 31] = glm::vec3(10.0F, 20.0F, 40.0F);
             scene.environment->map = map;
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
    const Variant variant = GetParam().value();
    Scene scene = variant.builder.scene();
    variant.change(scene);
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = placeInMedia(flattenCamera(scene.cameras.front(), 1.0F, variant.lens), flat);
    const Film light = renderCaustics(flat, camera, variant.settings, true);
    RenderSettings others = variant.settings;
    others.seed = 1;
    const Film path = renderCaustics(flat, camera, others, false);
    ASSERT_FALSE(light.splats.empty());
    EXPECT_TRUE(path.splats.empty());
    EXPECT_GT(meanOfSplats(light), 0.0);
    expectAgreement(GetParam().name, makePicture(light), makePicture(path));
}

INSTANTIATE_TEST_SUITE_P(Scenes, CausticsTest, testing::ValuesIn(kVariants), test::nameOfParameter);

// Up to 1 %, ten times the angle by which the directions of the lights differ.
void expectSameCaustics(const Film& one, const Film& other)
{
    const double a = meanOfSplats(one), b = meanOfSplats(other);
    const auto errorOf = [](const Film& film) {
        double sum = 0.0;
        for (const SplatMoments& splat : film.splats) {
            sum += static_cast<double>(splat.squares.g) / ((splat.blocks - 1.0) * splat.count);
        }
        return std::sqrt(sum) / static_cast<double>(film.splats.size());
    };
    std::printf("caustics %.6f and %.6f, +- %.1e\n", a, b, std::hypot(errorOf(one), errorOf(other)));
    EXPECT_GT(a, 0.0);
    EXPECT_LE(std::abs(a - b), twoSidedLimit(kCausticsLevel) * std::hypot(errorOf(one), errorOf(other)) + 0.01 * b);
}

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
    expectSameCaustics(sun, lamp);
}

// So is a sun of a map that is .7 degrees wide.
TEST(CausticsOfLightsTest, SmallSunOfAMapIsADirectionalLight)
{
    constexpr std::uint32_t kWidth = 512, kHeight = 256, kColumn = 180, kRow = 70;
    const auto map = std::make_shared<RadianceMap>(RadianceMap{kWidth, kHeight, std::vector<glm::vec3>(kWidth * kHeight), 0});
    map->texels[kRow * kWidth + kColumn] = glm::vec3(3e4F);
    const double polar = (kRow + 0.5) * pi / kHeight, azimuth = 2.0 * pi * ((kColumn + 0.5) / kWidth - 0.5);
    const glm::vec3 towards(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
    // The texel's solid angle, which the bilinear interpolant does not change.
    const auto irradiance = static_cast<float>(3e4 * 2.0 * pi / kWidth * pi / kHeight * std::sin(polar));
    const auto render = [&](bool fromMap) {
        SceneBuilder b;
        b.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, b.lambert(glm::vec3(0.7F)));
        addGlass(b);
        addMirror(b);
        b.perspective({0.0F, 2.0F, 4.0F}, {0, -1, 0}, 0.8F);
        fromMap ? b.environment(Environment{glm::vec3(1.0F), map, 0.0F, true, "test"})
                : b.light({"", PunctualLight::Kind::Directional, {0, 0, 0}, -towards, glm::vec3(irradiance)});
        return renderScene(b.scene(), squareSettings(32, samplesFor(512)));
    };
    expectSameCaustics(render(true), render(false));
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
    Scene sunny = sky.scene();
    addSunnySky(sunny);
    EXPECT_TRUE(needs(sunny));
    EXPECT_NE(flattened(sunny).features & kFeatureBrightEnvironment, 0U);
    auto map = std::make_shared<RadianceMap>(*sunny.environment->map);  // as wide as a studio's lights
    for (std::size_t i = 0; i < map->texels.size() / 2; ++i) {
        map->texels[i] = i % 32 < 8 ? glm::vec3(4.0F) : map->texels[i];
    }
    sunny.environment->map = map;
    EXPECT_FALSE(needs(sunny));
    EXPECT_EQ(flattened(balls().builder.scene()).features & kFeatureBrightEnvironment, 0U);
    EXPECT_FALSE(flattened(balls().builder.scene()).hasHiddenCaustics);
    SceneBuilder pointed = balls().builder;
    pointed.light({"", PunctualLight::Kind::Point, {0, 0, 0}, {0, 0, -1}, glm::vec3(1.0F)});
    EXPECT_TRUE(flattened(pointed.scene()).hasHiddenCaustics);
    Scene rough = room().builder.scene();
    addSmooth(rough, plastic(0.1F), {0, 0, 0}, 0.5F);
    EXPECT_FALSE(needs(rough));
}

}  // namespace
}  // namespace glim
