// Whole pictures with lights that touch walls, tiny lights, a million lights, and a small object in a large hall.
#include "host/measure/z_test.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/irradiance_formulas.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 64;
constexpr double kAlbedo = 0.5;

// A floor seen 2 mm wide, so that the formula at the point is the picture's mean.
SceneBuilder floorScene(float half = 5.0F)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-half, 0, half), {half, 0, half}, {half, 0, -half}, {-half, 0, -half}}, builder.lambert(glm::vec3(0.5F)));
    builder.orthographic({0.03F, 0.05F, 0.02F}, {0, 0, 0}, 1e-3F);
    return builder;
}

std::array<glm::vec3, 4> downQuad(float half, float y)
{
    return {glm::vec3(-half, y, -half), {half, y, -half}, {half, y, half}, {-half, y, half}};
}

double irradianceOf(std::span<const glm::vec3> corners)
{
    return computePolygonIrradiance(std::vector<glm::dvec3>(corners.begin(), corners.end()), {0, 1, 0});
}

RenderSettings oneBounce()
{
    RenderSettings settings = squareSettings(kSide, static_cast<std::uint32_t>(hardTrials(kSide * kSide * 64) / (kSide * kSide)));
    settings.bounces = 1;
    return settings;
}

// `lift`: the relative change that is allowed for the height at which rays leave the floor.
void expectFloor(const std::string& number, const std::string& name, const Scene& scene, double irradiance, double lift = 0.0)
{
    const double truth = kAlbedo * irradiance / std::numbers::pi;
    const Film film = renderScene(scene, oneBounce());
    const MeanEstimate mean = meanOf(film);
    printHardCase(number, name, 1.0 * kSide * kSide * oneBounce().sampleEnd,
                  "mean off by " + figure(mean.mean.g / truth - 1.0) + " +- " + figure(mean.standardError.g / truth));
    if (lift == 0.0) {
        expectMean(name, film, glm::dvec3(truth));
    } else {
        EXPECT_NEAR(mean.mean.g, truth, lift * truth + scoreLimit(200) * mean.standardError.g);
    }
}

// A scene, and the irradiance by the formula.
std::pair<Scene, double> lampBelowTheCeiling(float gap)
{
    SceneBuilder builder = floorScene();
    builder.quad(downQuad(2.0F, 1.5F), builder.lambert(glm::vec3(0.5F)));
    const auto lamp = downQuad(0.5F, 1.5F - gap);
    builder.quad(lamp, builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
    return {builder.scene(), irradianceOf(lamp)};
}

// In one plane with the ceiling, rounding would decide which of the two a ray meets, and the light would lack 1.3 % (lift_lights.hpp).
TEST(HardLightTest, H10LightTouchingTheCeiling)
{
    for (const float gap : {0.0F, 1e-4F, 1e-2F}) {
        const auto [scene, irradiance] = lampBelowTheCeiling(gap);
        expectFloor("H10", "lamp " + figure(static_cast<double>(gap)) + " below the ceiling", scene, irradiance);
    }
}

// A lamp that stands on the floor and ends at a wall: edges coincide with both.
TEST(HardLightTest, H10LightAgainstAWall)
{
    SceneBuilder builder = floorScene();
    const std::array<glm::vec3, 4> lamp = {glm::vec3(1, 0, 0), {1, 0, 0.7F}, {1, 0.6F, 0.7F}, {1, 0.6F, 0}};
    builder.quad(lamp, builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F), true));
    builder.quad({glm::vec3(0.5F, 0, 0.7F), {1.5F, 0, 0.7F}, {1.5F, 2, 0.7F}, {0.5F, 2, 0.7F}}, builder.lambert(glm::vec3(0.0F)));
    expectFloor("H10", "lamp between floor and wall", builder.scene(), irradianceOf(lamp));
}

// Of lamps in one place a ray meets the first (lift_lights.hpp), and sampled lights agree: both lit the floor before.
void expectFloorInAllWays(const std::string& name, const Scene& scene, double irradiance)
{
    for (const auto& [way, direct] :
         {std::pair("mis", DirectLight::Mis), std::pair("lights", DirectLight::Lights), std::pair("bsdf", DirectLight::Bsdf)}) {
        RenderSettings settings = squareSettings(32, 64);  // more would see the lift
        settings.bounces = 1;
        settings.course.direct = direct;
        expectMean(name + ", " + way, renderScene(scene, settings), glm::dvec3(kAlbedo * irradiance / std::numbers::pi));
    }
}

std::array<glm::vec3, 4> turned(const std::array<glm::vec3, 4>& corners) { return {corners[1], corners[2], corners[3], corners[0]}; }

std::array<glm::vec3, 4> upside(const std::array<glm::vec3, 4>& corners) { return {corners[3], corners[2], corners[1], corners[0]}; }

std::array<glm::vec3, 4> shifted(std::array<glm::vec3, 4> corners, const glm::vec3& by)
{
    for (glm::vec3& corner : corners) {
        corner += by;
    }
    return corners;
}

struct LampQuad {
    std::array<glm::vec3, 4> corners;
    float radiance;
    bool doubleSided = false;
};

Scene lampsAboveTheFloor(const std::vector<LampQuad>& lamps)
{
    SceneBuilder builder = floorScene();
    for (const LampQuad& lamp : lamps) {
        builder.quad(lamp.corners, builder.lambert(glm::vec3(0.0F), glm::vec3(lamp.radiance), lamp.doubleSided));
    }
    return builder.scene();
}

TEST(HardLightTest, OfCoincidentLightsTheFirstShines)
{
    const std::array<glm::vec3, 4> lamp = downQuad(0.5F, 1.5F), below = shifted(lamp, {0, -1e-6F, 0});
    const double irradiance = irradianceOf(lamp);
    expectFloorInAllWays("the same lamp twice", lampsAboveTheFloor({{lamp, 1.0F}, {lamp, 3.0F}}), irradiance);
    expectFloorInAllWays("its corners in another order", lampsAboveTheFloor({{lamp, 1.0F}, {turned(turned(lamp)), 1.0F}}), irradiance);
    expectFloorInAllWays("along the other diagonal", lampsAboveTheFloor({{lamp, 1.0F}, {turned(lamp), 3.0F}}), irradiance);
    expectFloorInAllWays("doubled faces", lampsAboveTheFloor({{upside(lamp), 3.0F}, {lamp, 1.0F}}), irradiance);
    expectFloorInAllWays("double-sided and one-sided", lampsAboveTheFloor({{lamp, 1.0F, true}, {lamp, 3.0F}}), irradiance);
    expectFloorInAllWays("one-sided and double-sided", lampsAboveTheFloor({{lamp, 1.0F}, {turned(lamp), 3.0F, true}}), irradiance);
    expectFloorInAllWays("from behind", lampsAboveTheFloor({{upside(lamp), 1.0F, true}, {turned(lamp), 3.0F, true}}), irradiance);
    expectFloorInAllWays("1e-6 m apart", lampsAboveTheFloor({{lamp, 3.0F}, {below, 1.0F}}), irradiance);
}

TEST(HardLightTest, LampsThatOverlapInOnePlane)
{
    const std::array<glm::vec3, 4> lamp = downQuad(0.5F, 1.5F), aside = shifted(lamp, {0.4F, 0, 0}), farther = shifted(lamp, {0.7F, 0, 0});
    const auto both = [](const auto& a, const auto& b) { return std::array{a[0], b[1], b[2], a[3]}; };
    expectFloorInAllWays("two that overlap", lampsAboveTheFloor({{lamp, 1.0F}, {aside, 1.0F}}), irradianceOf(both(lamp, aside)));
    // The last one is covered by both others.
    const double seen = irradianceOf(both(lamp, aside)) + 3.0 * (irradianceOf(both(lamp, farther)) - irradianceOf(both(lamp, aside)));
    expectFloorInAllWays("three that overlap", lampsAboveTheFloor({{aside, 1.0F}, {lamp, 1.0F}, {farther, 3.0F, true}}), seen);
}

TEST(HardLightTest, ADoubleSidedLampInTheCeiling)
{
    const std::array<glm::vec3, 4> lamp = downQuad(0.5F, 1.5F), ceiling = downQuad(2.0F, 1.5F);
    for (const auto& corners : {lamp, upside(lamp)}) {
        for (const auto& wall : {ceiling, upside(ceiling)}) {
            SceneBuilder builder = floorScene();
            builder.quad(wall, builder.lambert(glm::vec3(0.5F)));
            builder.quad(corners, builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F), true));
            expectFloorInAllWays("a double-sided lamp in the ceiling", builder.scene(), irradianceOf(lamp));
        }
    }
}

TEST(HardLightTest, CoincidentSpheres)
{
    const double irradiance = computeSphereIrradiance({0, 1.5, 0}, 0.5, {0, 1, 0});
    for (const bool lit : {false, true}) {
        SceneBuilder builder = floorScene();
        const std::uint32_t first = builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F)),
                            other = builder.lambert(glm::vec3(0.5F), glm::vec3(lit ? 3.0F : 0.0F));
        builder.sphere({0, 1.5F, 0}, 0.5F, lit ? first : other).sphere({0, 1.5F, 0}, 0.5F, lit ? other : first);
        expectFloorInAllWays(lit ? "two lamps" : "a ball and a lamp", builder.scene(), irradiance);
    }
}

// Within a ball of radiance 1 and albedo .5 one bounce gives 1.5. The one-sided lamp in its place is not there from within.
TEST(HardLightTest, CoincidentSpheresFromWithin)
{
    for (const bool oneSidedFirst : {false, true}) {
        SceneBuilder builder;
        const std::uint32_t ball = builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F), true),
                            other = builder.lambert(glm::vec3(0.0F), glm::vec3(3.0F));
        builder.sphere({0, 0, 0}, 0.5F, oneSidedFirst ? other : ball).sphere({0, 0, 0}, 0.5F, oneSidedFirst ? ball : other);
        for (const bool inside : {false, true}) {
            const glm::vec3 eye(0, 0, inside ? 0.2F : 2.0F);
            RenderSettings settings = squareSettings(16, 64);
            SceneBuilder seen = builder;
            seen.perspective(eye, {0, 0, -1}, 0.2F);
            for (const DirectLight direct : {DirectLight::Mis, DirectLight::Lights, DirectLight::Bsdf}) {
                settings.bounces = 1;
                settings.course.direct = direct;
                const double truth = inside ? 1.5 : oneSidedFirst ? 3.0 : 1.0;
                expectMean(inside ? "from within" : "from without", renderScene(seen.scene(), settings), glm::dvec3(truth));
            }
        }
    }
}

// 24 lamps that the floor sees, and one in a closed black box, of ten times their power, which takes most of the choices.
TEST(HardLightTest, H14AStrongLampThatIsHidden)
{
    SceneBuilder builder = floorScene();
    double irradiance = 0.0;
    const std::uint32_t lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(3.0F));
    for (int i = 0; i < 24; ++i) {
        std::array<glm::vec3, 4> corners = downQuad(0.05F, 1.0F + 0.02F * static_cast<float>(i));
        for (glm::vec3& corner : corners) {
            corner += glm::vec3(0.4F * static_cast<float>(i % 6) - 1.0F, 0.0F, 0.4F * static_cast<float>(i / 6) - 0.6F);
        }
        builder.quad(corners, lamp);
        irradiance += 3.0 * irradianceOf(corners);
    }
    const std::uint32_t black = builder.lambert(glm::vec3(0.0F));
    const glm::vec3 a(3.8F, 0.6F, -0.2F), b(4.2F, 0.8F, 0.2F);  // the box
    builder.quad({a, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}, black)
        .quad({glm::vec3(a.x, b.y, a.z), {b.x, b.y, a.z}, b, {a.x, b.y, b.z}}, black)
        .quad({a, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}}, black)
        .quad({glm::vec3(a.x, a.y, b.z), {b.x, a.y, b.z}, b, {a.x, b.y, b.z}}, black)
        .quad({a, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}}, black)
        .quad({glm::vec3(b.x, a.y, a.z), {b.x, a.y, b.z}, b, {b.x, b.y, a.z}}, black);
    builder.quad({glm::vec3(3.9F, 0.7F, -0.1F), {4.1F, 0.7F, -0.1F}, {4.1F, 0.7F, 0.1F}, {3.9F, 0.7F, 0.1F}},
                 builder.lambert(glm::vec3(0.0F), glm::vec3(180.0F)));
    expectFloor("H14", "a hidden lamp of ten times the power of all others", builder.scene(), irradiance);
}

// A lamp of 4 m above a lid with a hole of 20 cm: the floor sees the lamp through all of the hole and nowhere else.
TEST(HardLightTest, H14LightThroughAKeyhole)
{
    SceneBuilder builder = floorScene();
    const std::uint32_t lid = builder.lambert(glm::vec3(0.0F));
    const float h = 0.1F, w = 5.0F, y = 0.5F;
    builder.quad({glm::vec3(-w, y, -w), {w, y, -w}, {w, y, -h}, {-w, y, -h}}, lid)
        .quad({glm::vec3(-w, y, h), {w, y, h}, {w, y, w}, {-w, y, w}}, lid)
        .quad({glm::vec3(-w, y, -h), {-h, y, -h}, {-h, y, h}, {-w, y, h}}, lid)
        .quad({glm::vec3(h, y, -h), {w, y, -h}, {w, y, h}, {h, y, h}}, lid);
    builder.quad(downQuad(2.0F, 1.0F), builder.lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
    expectFloor("H14", "a lamp through a keyhole", builder.scene(), 5.0 * irradianceOf(downQuad(h, y)));
}

TEST(HardLightTest, H13PinholeLight)
{
    for (const float half : {1e-3F, 1e-6F}) {
        SceneBuilder builder = floorScene();
        const auto lamp = downQuad(half, 1.0F);
        const double radiance = 1.0 / (4.0 * static_cast<double>(half) * static_cast<double>(half));
        builder.quad(lamp, builder.lambert(glm::vec3(0.0F), glm::vec3(static_cast<float>(radiance))));
        expectFloor("H13", "lamp of " + figure(2.0 * static_cast<double>(half)) + " m", builder.scene(),
                    static_cast<double>(static_cast<float>(radiance)) * irradianceOf(lamp));
    }
}

// 1 to 2 mm above the floor, 1 m away. Rays leave a floor of 10 m at a height of 6e-6 m, from which the lamp is lower by that.
TEST(HardLightTest, H13GrazingLight)
{
    for (const float half : {0.1F, 5.0F}) {
        SceneBuilder builder = floorScene(half);
        const std::array<glm::vec3, 4> lamp = {glm::vec3(-1, 1e-3F, -0.5F), {-1, 1e-3F, 0.5F}, {-1, 2e-3F, 0.5F}, {-1, 2e-3F, -0.5F}};
        builder.quad(lamp, builder.lambert(glm::vec3(0.0F), glm::vec3(100.0F), true));
        expectFloor("H13", "lamp .1 degrees high, floor of " + figure(2.0 * static_cast<double>(half)) + " m", builder.scene(),
                    100.0 * irradianceOf(lamp), half > 1.0F ? 6e-6 / 1.5e-3 : 0.0);
    }
}

// 1e6 triangles of 64 brightnesses, over a square.
TEST(HardLightTest, H14AMillionEmitters)
{
    constexpr int kColumns = 1000, kRows = 500, kShades = 64;
    Scene scene = floorScene().scene();
    double irradiance = 0.0;
    const auto firstShade = static_cast<std::uint32_t>(scene.materials.size());
    for (int i = 0; i < kShades; ++i) {
        scene.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(std::exp2(0.25F * static_cast<float>(i) - 8.0F))));
    }
    const auto corner = [](int i, int j) {
        return glm::vec3(static_cast<float>(i) / kColumns - 0.5F, 1.0F, static_cast<float>(j) / kRows - 0.5F);
    };
    // Two triangles of each brightness, placed again and again: an instance is a light.
    const auto firstMesh = static_cast<std::uint32_t>(scene.meshes.size());
    const glm::vec3 a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
    const Triangle halves[2] = {{{a, b, c}}, {{a, c, d}}};
    for (std::uint32_t shade = 0; shade < kShades; ++shade) {
        for (const Triangle& half : halves) {
            addMesh(scene, {half}, firstShade + shade);
            scene.instances.pop_back();
        }
    }
    std::uint32_t count = 2;  // the floor has two triangles
    for (int i = 0; i < kColumns; ++i) {
        for (int j = 0; j < kRows; ++j) {
            const glm::vec3 shift = corner(i, j) - a;
            for (std::uint32_t half = 0; half < 2; ++half) {
                const std::uint32_t shade = (count++ * 2654435761U >> 20) % kShades;
                glm::dmat4 worldFromMesh(1.0);
                worldFromMesh[3] = glm::dvec4(shift, 1.0);
                scene.instances.push_back({"", firstMesh + 2 * shade + half, worldFromMesh});
                const auto& v = halves[half].vertices;
                irradiance += static_cast<double>(scene.materials[firstShade + shade].emission.g) *
                              irradianceOf(std::array{v[0] + shift, v[1] + shift, v[2] + shift});
            }
        }
    }
    expectFloor("H14", "1e6 emitters", scene, irradiance);
}

// A ring of 1 cm in a hall of 1 km whose walls shine evenly: the ring under an even sky.
TEST(HardLightTest, H7TeapotInAStadium)
{
    constexpr int kAround = 48, kAcross = 24;
    const auto point = [](int i, int j) {
        const double u = 2.0 * std::numbers::pi * (i % kAround) / kAround, v = 2.0 * std::numbers::pi * (j % kAcross) / kAcross;
        const double r = 7e-3 + 3e-3 * std::cos(v);
        return glm::vec3(r * std::cos(u), 3e-3 * std::sin(v), r * std::sin(u));
    };
    Scene ring = SceneBuilder().perspective({0.012F, 0.02F, 0.012F}, {0, 0, 0}, 0.7F).environment(glm::vec3(1.0F)).scene();
    ring.materials.push_back(makeLambert(glm::vec3(0.8F)));
    Triangles triangles;
    for (int i = 0; i < kAround; ++i) {
        for (int j = 0; j < kAcross; ++j) {
            const glm::vec3 a = point(i, j), b = point(i, j + 1), c = point(i + 1, j + 1), d = point(i + 1, j);
            triangles.push_back({{a, b, c}});
            triangles.push_back({{a, c, d}});
        }
    }
    addMesh(ring, triangles);
    Scene hall = ring;
    hall.environment.reset();
    hall.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(1.0F)));
    const Scene walls = SceneBuilder().cube(500.0F, 1, true).scene();
    hall.meshes.change().push_back(walls.meshes[0]);
    hall.instances.push_back({"", 1});
    RenderSettings settings = squareSettings(kSide, oneBounce().sampleEnd);
    settings.sampler = Sampler::Independent;
    const Film sky = renderScene(ring, settings);
    settings.seed = 1;
    settings.course.direct = DirectLight::Bsdf;
    const ZTest z = zTest(makePicture(renderScene(hall, settings)), makePicture(sky), 1e-3 / 200.0);
    printHardCase("H7", "a ring of 1 cm in a hall of 1 km", 1.0 * kSide * kSide * settings.sampleEnd,
                  "z of the mean " + figure(z.meanZ[1]) + ", worst block " + figure(z.worstZ) + " of " + figure(z.blockLimit));
    EXPECT_TRUE(z.agrees());
}

}  // namespace
}  // namespace glim
